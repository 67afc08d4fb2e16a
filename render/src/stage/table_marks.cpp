// Painted or inlaid marks of a table: diamonds, strings and spots.
#include "stage/mesh_builder.h"

#include <cmath>
#include <string_view>
#include <vector>

namespace carom::render {

namespace {

constexpr double kAboveCloth = 0.0005;  // [m] height of painted marks above the cloth

// [m] The shader draws the edge of a mark one pixel wide; the triangles reach this far beyond the mark.
constexpr double kEdge = 0.008;

void line(MeshBuilder& builder, const std::vector<Vec2>& points, double width, double opacity) {
    Chain chain;
    chain.points = points;
    chain.heights.assign(points.size(), kAboveCloth);
    const double reach = 0.5 * width + kEdge, across = reach / (0.5 * width);
    builder.sweep(chain, {{-reach, 0.0, opacity, -across}, {reach, 0.0, opacity, across}}, Material::kChalk,
                  false);
}

void spot(MeshBuilder& builder, const Vec2& center, double radius) {
    builder.disc(center, radius + kEdge, kAboveCloth, Material::kChalk, 0.75, (radius + kEdge) / radius);
}

void diamond(MeshBuilder& builder, const Vec2& center, double z, bool along_y) {
    // Mother of pearl in a dark line.
    for (const bool line : {true, false}) {
        const double lengthwise = line ? 0.0165 : 0.014, across = line ? 0.0082 : 0.007;
        const double dx = along_y ? across : lengthwise, dy = along_y ? lengthwise : across;
        const double height = line ? z - 0.0004 : z;
        const auto at = [&](double x, double y) { return Vec3(center.x() + x, center.y() + y, height); };
        builder.quad(at(-dx, 0.0), at(0.0, -dy), at(dx, 0.0), at(0.0, dy),
                     line ? Material::kTrim : Material::kInlay);
    }
}

void add_diamonds(const Table& table, const TableMesh& mesh, MeshBuilder& builder, double rail) {
    const double z = mesh.wood_top + 0.0006;
    for (int i = 1; i < 8; ++i) {
        if (i == 4 && !table.pockets.empty()) continue;  // the side pocket is here
        const double y = table.length * i / 8.0;
        diamond(builder, {-rail, y}, z, true);
        diamond(builder, {table.width + rail, y}, z, true);
    }
    for (int i = 1; i < 4; ++i) {
        const double x = table.width * i / 4.0;
        diamond(builder, {x, -rail}, z, false);
        diamond(builder, {x, table.length + rail}, z, false);
    }
}

// Baulk line, D and the six spots of an English table.
void add_snooker_marks(const Table& table, MeshBuilder& builder) {
    const Vec2 brown = snooker_spot(table, "brown");
    const double d = radius_of_d(table);
    line(builder, {{0.0, brown.y()}, {table.width, brown.y()}}, 0.002, 0.45);
    constexpr int kPieces = 48;  // [-] straight pieces of the D
    std::vector<Vec2> arc;
    for (int i = 0; i <= kPieces; ++i) {
        const double angle = 3.14159265358979323846 * i / kPieces;
        arc.emplace_back(brown - d * Vec2(std::cos(angle), std::sin(angle)));
    }
    line(builder, arc, 0.002, 0.45);
    for (const std::string_view colour : kColours) spot(builder, snooker_spot(table, colour), 0.005);
}

}  // namespace

void add_table_marks(const Table& table, TableMesh& mesh, MeshBuilder& builder, double rail) {
    if (table.preset.empty() || table.width <= 0.0 || table.length <= 0.0) return;
    const double w = table.width, l = table.length;
    if (table.preset.starts_with("snooker")) {
        add_snooker_marks(table, builder);
        return;
    }
    add_diamonds(table, mesh, builder, rail);
    if (table.preset.starts_with("carom")) {
        for (double y : {0.25 * l, 0.5 * l, 0.75 * l}) spot(builder, {0.5 * w, y}, 0.006);
        return;
    }
    line(builder, {{0.0, 0.25 * l}, {w, 0.25 * l}}, 0.0016, 0.25);
    spot(builder, foot_spot(table), 0.0045);
}

std::vector<DiamondNumber> diamond_numbers(const Table& t, const TableMesh& mesh) {
    std::vector<DiamondNumber> numbers;
    if (!(t.width > 0.0 && t.length > 0.0)) return numbers;
    const Vec2 far = t.corner + Vec2(t.width, t.length);
    const Vec2 low = 0.5 * (t.corner + mesh.inner_low), high = 0.5 * (far + mesh.inner_high);
    const auto add = [&](const Vec2& at, int number) {
        for (const Pocket& p : t.pockets)
            if ((at - p.center).norm() < 1.6 * p.radius) return;
        numbers.push_back({at, number});
    };
    for (int k = 0; k <= 8; ++k)
        for (const double x : {low.x(), high.x()}) add({x, t.corner.y() + t.length * k / 8.0}, k);
    for (int k = 1; k < 4; ++k)
        for (const double y : {low.y(), high.y()}) add({t.corner.x() + t.width * k / 4.0, y}, k);
    return numbers;
}

}  // namespace carom::render
