// Hand-made records, to test drawing without the rest of the engine.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <iterator>
#include <limits>
#include <string>

#include "carom/engine/record.h"
#include "carom/render/image.h"

namespace carom::render_test {

inline constexpr double kR = 0.028575;

/// A rectangle of four cushions, corner at the origin.
inline Table rectangle_table(double width, double length) {
    Table table;
    table.width = width;
    table.length = length;
    const double h = 1.28 * kR;
    table.cushions = {{"south", {0.0, 0.0}, {width, 0.0}, h},
                      {"east", {width, 0.0}, {width, length}, h},
                      {"north", {width, length}, {0.0, length}, h},
                      {"west", {0.0, length}, {0.0, 0.0}, h}};
    return table;
}

inline Segment still(const Vec3& place) {
    Segment segment;
    segment.r = place;
    segment.v = segment.w = Vec3::Zero();
    segment.a = segment.dw = Vec2::Zero();
    segment.duration = std::numeric_limits<double>::infinity();
    return segment;
}

inline void add_ball(Record& record, const std::string& id, const Segment& segment) {
    BallTrack track;
    track.id = id;
    track.segments.push_back(segment);
    record.tracks.push_back(track);
}

inline void add_ball(Record& record, const std::string& id, double x, double y) {
    add_ball(record, id, still({x, y, kR}));
}

inline Record rectangle_record(double width = 1.0, double length = 2.0) {
    Record record;
    record.table = rectangle_table(width, length);
    record.balls.R = kR;
    record.duration = 1.0;
    return record;
}

inline bool same_pixels(const render::Image& a, const render::Image& b) {
    return a.size == b.size && a.rgbx == b.rgbx;
}

class ScratchFolder {
  public:
    explicit ScratchFolder(const std::string& name)
        : path_(std::filesystem::temp_directory_path() /
                ("carom_render_" + name + "_" + std::to_string(::getpid()))) {
        std::filesystem::remove_all(path_);
        std::filesystem::create_directory(path_);
    }
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::permissions(path_, std::filesystem::perms::owner_all, ignored);
        std::filesystem::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    std::string file(const std::string& name) const { return (path_ / name).string(); }
    const std::filesystem::path& path() const { return path_; }
    std::size_t entries() const {
        const std::filesystem::recursive_directory_iterator all(path_);
        return static_cast<std::size_t>(std::distance(begin(all), end(all)));
    }

  private:
    std::filesystem::path path_;
};

}  // namespace carom::render_test
