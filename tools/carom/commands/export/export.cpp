// A shot as glTF: the table, the balls, and their motion as one animation.

#include <fmt/core.h>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "base/console.h"
#include "base/options.h"
#include "base/setup.h"
#include "carom/render/ball_texture.h"
#include "carom/render/draw_list.h"
#include "carom/render/look.h"
#include "carom/render/png.h"
#include "commands/export/gltf.h"
#include "report/table.h"

namespace carom::tools {
namespace {

using Json = Gltf::Json;
using render::Material;
namespace look = render::look;

constexpr int kVertices = 34962;  // buffer target of vertices, from the specification
// [-] segments around a ball; half as many from pole to pole
constexpr int kSpherePieces = 48;
constexpr int kTextureWidth = 512, kPngLevel = 9;  // [px], of zlib

/// How a material reflects.
struct Surface {
    const char* name;
    look::Color color;  ///< screen values, whose squares are reflected
    double roughness;
};

const Surface& surface_of(Material material) {
    static const std::map<Material, Surface> surfaces = {
        {Material::kCloth, {"cloth", look::kCloth, 1.0}},
        {Material::kCushion, {"cushion", look::kCloth, 1.0}},
        {Material::kWood, {"wood", look::kPlainWood, 0.45}},
        {Material::kPocket, {"pocket", look::kPlainPocket, 0.9}},
        {Material::kTrim, {"trim", look::kTrim, 0.4}},
        {Material::kInlay, {"inlay", look::kInlay, 0.3}},
        {Material::kChalk, {"chalk", look::kPlainChalk, 1.0}},
    };
    return surfaces.at(material);
}

Json array_of(const auto& values) {
    Json list = Json::array();
    for (const float x : values) list.push_back(x);
    return list;
}

std::size_t add_table(Gltf& file, const render::TableMesh& table) {
    Json primitives = Json::array();
    for (const auto& [material, part] : table_parts(table)) {
        const Surface& surface = surface_of(material);
        Json color = Json::array();
        const double gain = material == Material::kCushion ? look::kCushionGain : 1.0;
        const bool cloth = material == Material::kCloth || material == Material::kCushion;
        for (const double c : cloth ? table.cloth : surface.color) color.push_back(gain * c * c);
        color.push_back(1.0);
        Json look = {
            {"name", surface.name},
            {"pbrMetallicRoughness",
             {{"baseColorFactor", color}, {"metallicFactor", 0.0}, {"roughnessFactor", surface.roughness}}}};
        if (material == Material::kPocket) look["doubleSided"] = true;
        const std::size_t number = file.add("materials", std::move(look));
        primitives.push_back({{"attributes",
                               {{"POSITION", file.add_floats(part.positions, "VEC3", kVertices)},
                                {"NORMAL", file.add_floats(part.normals, "VEC3", kVertices)}}},
                              {"indices", file.add_indices(part.indices)},
                              {"material", number}});
    }
    const std::size_t mesh = file.add("meshes", {{"name", "table"}, {"primitives", primitives}});
    const Vec3 origin(table.origin.x(), table.origin.y(), 0.0);
    return file.add("nodes",
                    {{"name", "table"}, {"mesh", mesh}, {"translation", array_of(gltf_axes(origin))}});
}

/// A unit sphere, whose accessors all balls share. Its poles are those of ball_texture().
class Sphere {
  public:
    explicit Sphere(Gltf& file) {
        constexpr int kRows = kSpherePieces / 2;
        std::vector<float> places, texture;
        std::vector<std::uint32_t> indices;
        for (int j = 0; j <= kRows; ++j) {
            for (int i = 0; i <= kSpherePieces; ++i) {
                // Each triangle at a pole has its own corner there, in the middle of its part of the texture.
                const double column = i + (j == 0 || j == kRows ? 0.5 : 0.0);
                const double phi = 2.0 * std::numbers::pi * column / kSpherePieces,
                             theta = std::numbers::pi * j / kRows;
                const double ring = j == 0 || j == kRows ? 0.0 : std::sin(theta);
                const Vec3 n(j == kRows ? -1.0 : std::cos(theta), ring * std::cos(phi), ring * std::sin(phi));
                for (const float x : gltf_axes(n)) places.push_back(x);
                texture.push_back(static_cast<float>(column / kSpherePieces));
                texture.push_back(static_cast<float>(j) / kRows);
                if (j == kRows || i == kSpherePieces) continue;
                const auto at = static_cast<std::uint32_t>(j * (kSpherePieces + 1) + i),
                           below = at + kSpherePieces + 1;
                if (j > 0) indices.insert(indices.end(), {at, below, at + 1});
                if (j + 1 < kRows) indices.insert(indices.end(), {j == 0 ? at : at + 1, below, below + 1});
            }
        }
        positions_ = file.add_floats(places, "VEC3", kVertices);
        texture_ = file.add_floats(texture, "VEC2", kVertices);
        indices_ = file.add_indices(indices);
    }

    Json primitive(std::size_t material) const {
        // On a unit sphere, a position is its own normal.
        return {{"attributes", {{"POSITION", positions_}, {"NORMAL", positions_}, {"TEXCOORD_0", texture_}}},
                {"indices", indices_},
                {"material", material}};
    }

  private:
    std::size_t positions_, texture_, indices_;
};

std::size_t add_ball_mesh(Gltf& file, const Sphere& sphere, const std::string& id,
                          const render::BallStyle& style) {
    std::vector<std::uint8_t> png;
    render::encode_png(render::ball_texture(style, kTextureWidth), kPngLevel, png);
    const std::size_t texture = file.add_png(png);
    const std::size_t material = file.add(
        "materials",
        {{"name", "ball " + id},
         {"pbrMetallicRoughness",
          {{"baseColorTexture", {{"index", texture}}}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.1}}}});
    return file.add("meshes",
                    {{"name", "ball " + id}, {"primitives", Json::array({sphere.primitive(material)})}});
}

/// One animation; its channels are added ball by ball.
class Animation {
  public:
    void add(std::size_t node, const char* path, std::size_t input, std::size_t output,
             const char* interpolation) {
        samplers_.push_back({{"input", input}, {"output", output}, {"interpolation", interpolation}});
        channels_.push_back(
            {{"sampler", samplers_.size() - 1}, {"target", {{"node", node}, {"path", path}}}});
    }
    void write(Gltf& file) const {
        if (!samplers_.empty())
            file.add("animations", {{"name", "shot"}, {"samplers", samplers_}, {"channels", channels_}});
    }

  private:
    Json samplers_ = Json::array(), channels_ = Json::array();
};

void animate(Gltf& file, Animation& animation, std::size_t node, const Record& record, int ball,
             const GltfOptions& options) {
    std::vector<float> times, values;
    const std::vector<PositionKey> cubic = position_keys(record, ball);
    if (cubic.size() > 1) {
        const auto keys = options.linear ? sampled_position_keys(record, ball, options.fps) : cubic;
        for (const PositionKey& key : keys) {
            times.push_back(key.time);
            if (!options.linear) values.insert(values.end(), key.before.begin(), key.before.end());
            values.insert(values.end(), key.place.begin(), key.place.end());
            if (!options.linear) values.insert(values.end(), key.after.begin(), key.after.end());
        }
        animation.add(node, "translation", file.add_floats(times, "SCALAR"), file.add_floats(values, "VEC3"),
                      options.linear ? "LINEAR" : "CUBICSPLINE");
    }
    const std::vector<RotationKey> turns = rotation_keys(record, ball);
    if (turns.size() < 2) return;
    times.clear();
    values.clear();
    for (const RotationKey& key : turns) {
        times.push_back(key.time);
        values.insert(values.end(), key.q.begin(), key.q.end());
    }
    animation.add(node, "rotation", file.add_floats(times, "SCALAR"), file.add_floats(values, "VEC4"),
                  "LINEAR");
}

}  // namespace

std::string shot_gltf(const Record& record, const GltfOptions& options) {
    Gltf file("carom " + program_version());
    const render::Stage stage(record, {});
    Json roots = Json::array({add_table(file, *stage.table())});
    const Sphere sphere(file);
    Animation animation;
    std::map<std::pair<std::string, int>, std::size_t> meshes;
    for (std::size_t i = 0; i < record.tracks.size(); ++i) {
        const int ball = static_cast<int>(i);
        const std::string& id = record.tracks[i].id;
        const std::size_t mesh =
            add_ball_mesh(file, sphere, id, render::ball_style(id, record.table.preset, ball));
        const double R = record.size(ball).R;
        const std::size_t node =
            file.add("nodes", {{"name", id},
                               {"mesh", mesh},
                               {"translation", array_of(gltf_axes(record.state_at(ball, 0.0).position))},
                               {"scale", {R, R, R}}});
        roots.push_back(node);
        animate(file, animation, node, record, ball, options);
    }
    animation.write(file);
    file.add("scenes", {{"name", "shot"}, {"nodes", roots}});
    file.json()["scene"] = 0;
    return file.bytes();
}

// carom export: a shot for 3D programs.

namespace {

struct ExportArgs {
    std::string input;
    std::string output = "shot.glb";
    std::string interpolation = "cubic";
    double fps = 120.0;
};

int run(const ExportArgs& args) {
    if (!args.output.ends_with(".glb"))
        throw UsageError(
            fmt::format("-o {}: the export is binary glTF; give a name that ends in .glb", args.output));
    GltfOptions options;
    options.linear = args.interpolation == "linear";
    options.fps = chosen_fps(args.fps, {});
    const Record record = read_shot(args.input, {});
    if (options.linear) checked_frame_count(0.0, record.duration, options.fps);
    const std::string bytes = shot_gltf(record, options);
    write_report(args.output, bytes);
    print(fmt::format("{}: {}, {:.3f} s, {} kB\n", args.output, counted(record.tracks.size(), "ball"),
                      record.duration, (bytes.size() + 500) / 1000));
    return kOk;
}

}  // namespace

void add_export(Options& program) {
    auto [command, args] =
        program.command<ExportArgs>("export", "Export a shot as glTF 2.0, for three.js, Godot, Blender", run);
    command.argument("SHOT", args.input, "Scene file (TOML) or record (.json)").required = true;
    command.option("-o,--output", &args.output, "FILE.glb", "File to write");
    command.option("--interpolation", &args.interpolation, "NAME", "cubic is exact; Blender needs linear")
        .one_of({"cubic", "linear"});
    command.option("--fps", &args.fps, "F", "Samples per second for linear");
}

}  // namespace carom::tools
