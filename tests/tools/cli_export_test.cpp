// carom export: every scene's file is valid glTF with the engine's positions and orientations.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "carom/engine/record.h"
#include "cli.h"

namespace carom::test {
namespace {

using Json = nlohmann::json;

std::uint32_t u32(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

/// The two parts of a .glb file.
struct Glb {
    Json json;
    std::string binary;

    explicit Glb(const std::string& file) {
        const std::string bytes = read_file(file);
        EXPECT_EQ(bytes.substr(0, 4), "glTF");
        EXPECT_EQ(u32(bytes, 4), 2u);
        EXPECT_EQ(u32(bytes, 8), bytes.size());
        const std::size_t length = u32(bytes, 12);
        json = Json::parse(bytes.substr(20, length));
        binary = bytes.substr(20 + length + 8);
    }

    std::vector<float> floats(std::size_t accessor) const {
        const Json& a = json.at("accessors").at(accessor);
        const Json& view = json.at("bufferViews").at(a.at("bufferView").get<std::size_t>());
        std::vector<float> list(view.at("byteLength").get<std::size_t>() / sizeof(float));
        std::memcpy(list.data(), binary.data() + view.at("byteOffset").get<std::size_t>(),
                    list.size() * sizeof(float));
        return list;
    }

    /// The sampler of a node's path, or null if it is not animated.
    Json sampler(std::size_t node, const std::string& path) const {
        if (!json.contains("animations")) return nullptr;
        const Json& animation = json.at("animations").at(0);
        for (const Json& channel : animation.at("channels"))
            if (channel.at("target").at("node") == node && channel.at("target").at("path") == path)
                return animation.at("samplers").at(channel.at("sampler").get<std::size_t>());
        return nullptr;
    }
};

/// The corners of a primitive's triangles, with small indices.
std::vector<std::array<std::uint16_t, 3>> triangles_of(const Glb& glb, const Json& primitive) {
    const Json& accessor = glb.json.at("accessors").at(primitive.at("indices").get<std::size_t>());
    const Json& view = glb.json.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
    EXPECT_EQ(accessor.at("componentType"), 5123);
    std::vector<std::array<std::uint16_t, 3>> list(accessor.at("count").get<std::size_t>() / 3);
    std::memcpy(list.data(), glb.binary.data() + view.at("byteOffset").get<std::size_t>(), list.size() * 6);
    return list;
}

/// A value of an animation, evaluated as specified, with `width` numbers per key.
std::vector<double> sampled(const Glb& glb, const Json& sampler, double t, std::size_t width) {
    const std::vector<float> times = glb.floats(sampler.at("input")),
                             values = glb.floats(sampler.at("output"));
    const bool cubic = sampler.at("interpolation") == "CUBICSPLINE";
    const std::size_t step = cubic ? 3 * width : width, place = cubic ? width : 0;
    EXPECT_EQ(values.size(), times.size() * step);
    const auto later = std::upper_bound(times.begin(), times.end(), static_cast<float>(t));
    const std::size_t next = std::min<std::size_t>(later - times.begin(), times.size() - 1),
                      k = next > 0 ? next - 1 : 0;
    std::vector<double> out(width);
    const double lasts = times[next] - times[k],
                 u = lasts > 0.0 ? std::clamp((t - times[k]) / lasts, 0.0, 1.0) : 0.0;
    for (std::size_t i = 0; i < width; ++i) {
        const double a = values[k * step + place + i], b = values[next * step + place + i];
        out[i] = a + u * (b - a);
        if (!cubic) continue;
        const double ta = lasts * values[k * step + 2 * width + i], tb = lasts * values[next * step + i];
        const double u2 = u * u, u3 = u2 * u;
        out[i] = (2 * u3 - 3 * u2 + 1) * a + (u3 - 2 * u2 + u) * ta + (3 * u2 - 2 * u3) * b + (u3 - u2) * tb;
    }
    return out;
}

struct Differences {
    double place = 0.0, turn = 0.0;  ///< largest [m], [rad]
};

/// Compares a file with the record, except within a float's resolution of the instants at which a position
/// jumps.
Differences differences(const Glb& glb, const Record& record) {
    Differences largest;
    for (int ball = 0; ball < static_cast<int>(record.tracks.size()); ++ball) {
        const std::size_t node = static_cast<std::size_t>(ball) + 1;
        const Json& object = glb.json.at("nodes").at(node);
        EXPECT_EQ(object.at("name"), record.tracks[ball].id);
        const Json move = glb.sampler(node, "translation"), turn = glb.sampler(node, "rotation");
        for (int k = 0; k <= 700; ++k) {
            const double t = record.duration * k / 700.0;
            const bool at_an_event =
                std::any_of(record.events.begin(), record.events.end(),
                            [t](const Event& event) { return std::abs(event.time - t) < 2e-6 * (1.0 + t); });
            if (at_an_event) continue;
            const BallState state = record.state_at(ball, t);
            const Vec3& r = state.position;
            std::vector<double> p = object.at("translation").get<std::vector<double>>();
            if (!move.is_null()) p = sampled(glb, move, t, 3);
            // The resolution of floats for positions and times: a ball beside the table falls for seconds.
            const double resolved = 0x1p-24 * (r.norm() + state.velocity.norm() * t);
            largest.place = std::max(largest.place, (Vec3(p[0], -p[2], p[1]) - r).norm() - resolved);
            std::vector<double> q = {0.0, 0.0, 0.0, 1.0};
            if (!turn.is_null()) q = sampled(glb, turn, t, 4);
            const Eigen::Quaterniond here = Eigen::Quaterniond(q[3], q[0], -q[2], q[1]).normalized();
            largest.turn = std::max(largest.turn, here.angularDistance(record.orientation_at(ball, t)));
        }
    }
    return largest;
}

Record record_of(const TemporaryFolder& folder, const std::string& scene) {
    const std::string file = folder.file("record.json");
    EXPECT_EQ(carom({"simulate", scene, "-o", file, "--hash"}).status, 0);
    return read_record(file);
}

TEST(Export, PlacesAreExactAndOrientationsClose) {
    const TemporaryFolder folder;
    Differences largest;
    for (const std::string& scene : shipped_scenes()) {
        const std::string file = folder.file("shot.glb");
        const ProcessResult made = carom({"export", scene, "-o", file});
        ASSERT_EQ(made.status, 0) << made.err;
        const Differences found = differences(Glb(file), record_of(folder, scene));
        // A float resolves 0.2 micrometres at 2 m, and 1 microsecond at 10 s, in which a ball moves 10
        // micrometres.
        EXPECT_LT(found.place, 1e-5) << scene;
        // Between two keys 0.4 rad apart, the rate has an error of up to 0.005 rad, and the axis changes.
        EXPECT_LT(found.turn, 0.025) << scene;
        largest.place = std::max(largest.place, found.place);
        largest.turn = std::max(largest.turn, found.turn);
    }
    std::printf("largest difference: %.2g m, %.2g rad\n", largest.place, largest.turn);
}

TEST(Export, ABallThatTurnsTooOftenIsRefused) {
    const TemporaryFolder folder;
    const std::string scene = folder.write(
        "spins.toml",
        "[balls]\nmu_s = 0\nmu_r = 0\nmu_sp = 0\n[[ball]]\nspin = [0, 0, 100]\n[stop]\ntime = 1e6\n");
    const ProcessResult result = carom({"export", scene, "-o", folder.file("spins.glb")});
    EXPECT_EQ(result.status, 2);
    EXPECT_TRUE(contains(result.err, "turns 1e+08 rad between 0.000 and 1e+06 s")) << result.err;
    EXPECT_FALSE(std::filesystem::exists(folder.file("spins.glb")));
}

TEST(Export, StraightLinesStayClose) {
    const TemporaryFolder folder;
    const std::string scene = CAROM_SOURCE_DIR "/scenes/jump_pot.toml", file = folder.file("shot.glb");
    const Record record = record_of(folder, scene);
    const auto made = [&](const char* fps) {
        EXPECT_EQ(carom({"export", scene, "-o", file, "--interpolation", "linear", "--fps", fps}).status, 0);
        return differences(Glb(file), record).place;
    };
    // A parabola of acceleration g deviates from its chord by g / 8 fps^2.
    EXPECT_LT(made("120"), 1.1 * 9.81 / 8.0 / 120.0 / 120.0);
    EXPECT_GT(made("30"), 0.2 * 9.81 / 8.0 / 30.0 / 30.0);
    const Glb glb(file);
    for (const Json& sampler : glb.json.at("animations").at(0).at("samplers"))
        EXPECT_EQ(sampler.at("interpolation"), "LINEAR");
}

TEST(Export, TheTableHasHolesAndTheBallsHaveTextures) {
    const TemporaryFolder folder;
    const std::string file = folder.file("shot.glb");
    ASSERT_EQ(carom({"export", folder.write("small.toml", kSmallScene), "-o", file}).status, 0);
    const Glb glb(file);
    std::vector<std::string> materials;
    for (const Json& material : glb.json.at("materials")) materials.push_back(material.at("name"));
    for (const char* name :
         {"cloth", "cushion", "wood", "pocket", "trim", "inlay", "chalk", "ball cue", "ball 1"})
        EXPECT_EQ(std::count(materials.begin(), materials.end(), name), 1) << name;
    EXPECT_EQ(glb.json.at("images").size(), 3u);
    // No triangle of the cloth covers the middle of a pocket.
    const Json& table = glb.json.at("meshes").at(0);
    const Vec2 origin(glb.json.at("nodes").at(0).at("translation").at(0),
                      -glb.json.at("nodes").at(0).at("translation").at(2).get<double>());
    const std::string record_file = folder.file("record.json");
    ASSERT_EQ(carom({"simulate", folder.file("small.toml"), "-o", record_file}).status, 0);
    const Record record = read_record(record_file);
    double area = 0.0;
    for (const Json& primitive : table.at("primitives")) {
        if (materials[primitive.at("material").get<std::size_t>()] != "cloth") continue;
        const std::vector<float> p = glb.floats(primitive.at("attributes").at("POSITION"));
        for (const auto& triangle : triangles_of(glb, primitive)) {
            const auto at = [&](std::size_t k) {
                const std::size_t v = triangle[k];
                return Vec2(p[3 * v] + origin.x(), -p[3 * v + 2] + origin.y());
            };
            const Vec2 a = at(0), b = at(1), c = at(2);
            area += 0.5 * cross(b - a, c - a);
            for (const Pocket& pocket : record.table.pockets) {
                const Vec2 m = pocket.center;
                EXPECT_FALSE(cross(b - a, m - a) > 0 && cross(c - b, m - b) > 0 && cross(a - c, m - c) > 0);
            }
        }
    }
    EXPECT_GT(area, 0.9 * record.table.width * record.table.length);
    EXPECT_LT(area, 1.2 * record.table.width * record.table.length);
}

TEST(Export, TheFacesOfABallPointOutwards) {
    const TemporaryFolder folder;
    const std::string file = folder.file("shot.glb");
    ASSERT_EQ(carom({"export", folder.write("small.toml", kSmallScene), "-o", file}).status, 0);
    const Glb glb(file);
    const Json& primitive = glb.json.at("meshes").at(1).at("primitives").at(0);
    const std::vector<float> p = glb.floats(primitive.at("attributes").at("POSITION")),
                             uv = glb.floats(primitive.at("attributes").at("TEXCOORD_0"));
    double area = 0.0, picture = 0.0;
    for (const auto& [a, b, c] : triangles_of(glb, primitive)) {
        const auto place = [&](std::size_t k) { return Vec3(p[3 * k], p[3 * k + 1], p[3 * k + 2]); };
        const auto texture = [&](std::size_t k) { return Vec2(uv[2 * k], uv[2 * k + 1]); };
        const Vec3 normal = (place(b) - place(a)).cross(place(c) - place(a));
        EXPECT_GT(normal.dot(place(a) + place(b) + place(c)), 0.0);
        area += 0.5 * normal.norm();
        picture += 0.5 * std::abs(cross(texture(b) - texture(a), texture(c) - texture(a)));
    }
    // Nearly the areas of a sphere and of the whole picture, of which the triangles at the poles use only
    // half.
    EXPECT_NEAR(area, 4.0 * 3.14159265, 0.1);
    EXPECT_NEAR(picture, 1.0 - 1.0 / 24.0, 1e-3);
}

TEST(Export, TheKhronosValidatorReportsNothing) {
    if (run_process({"npm", "--version"}).status != 0) GTEST_SKIP() << "npm is not installed";
    const TemporaryFolder folder;
    // Not a dependency of the project: fetched for this test if possible.
    const ProcessResult fetched =
        run_process({"npm", "install", "--prefix", folder.file("modules"), "--no-audit", "--no-fund",
                     "--fetch-retries=0", "--fetch-timeout=20000", "gltf-validator@2.0.0-dev.3.10"});
    if (fetched.status != 0) GTEST_SKIP() << "npm cannot fetch gltf-validator: " << fetched.err;
    std::vector<std::string> command = {"node", CAROM_SOURCE_DIR "/tests/tools/view/validate.mjs",
                                        folder.file("modules")};
    for (const std::string& scene : shipped_scenes()) {
        for (const char* interpolation : {"cubic", "linear"}) {
            const std::string name = std::filesystem::path(scene).stem().string();
            command.push_back(folder.file(name + "_" + interpolation + ".glb"));
            ASSERT_EQ(carom({"export", scene, "-o", command.back(), "--interpolation", interpolation}).status,
                      0);
        }
    }
    const ProcessResult result = run_process(command);
    EXPECT_EQ(result.status, 0) << result.out << result.err;
    EXPECT_TRUE(contains(result.out, ", 0 issues")) << result.out;
}

}  // namespace
}  // namespace carom::test
