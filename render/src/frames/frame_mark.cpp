#include "frames/frame_mark.h"

#include <zlib.h>

#include <array>
#include <cstdio>
#include <memory>
#include <string_view>
#include <variant>

#include "base/fnv.h"

namespace carom::render {

namespace {

// The text of a chunk: a keyword of the PNG specification, and the text that `identify -verbose` and exiftool
// then show.
constexpr std::string_view kBefore("tEXtComment\0frame of picture ", 29);
constexpr std::string_view kAfter = ", drawn by carom render";
constexpr std::size_t kMark = 46;  // of mark_at()
constexpr std::size_t kText = kBefore.size() + kMark + kAfter.size();
/// The last chunk of a PNG file is empty. A frame gets its name when it is complete, so only a power cut
/// leaves one without.
constexpr std::string_view kEnd("\0\0\0\0IEND\xAE\x42\x60\x82", 12);
constexpr std::string_view kSignature = "\x89PNG\r\n\x1A\n";

std::string big_endian(std::uint32_t x) {
    return {static_cast<char>(x >> 24U), static_cast<char>(x >> 16U), static_cast<char>(x >> 8U),
            static_cast<char>(x)};
}

/// The end of a marked frame: the chunk with its length and checksum, and the last chunk.
std::string tail_of(const std::string& mark) {
    const std::string text = std::string(kBefore) + mark + std::string(kAfter);
    const uLong check = crc32(0, reinterpret_cast<const Bytef*>(text.data()), static_cast<uInt>(text.size()));
    return big_endian(static_cast<std::uint32_t>(text.size() - 4)) + text +
           big_endian(static_cast<std::uint32_t>(check)) + std::string(kEnd);
}

void add_text(Fnv& all, const std::string& text) {
    all.add(std::uint64_t{text.size()});
    all.add(text);
}

template <class T, std::size_t kRows>
void add_rows(Fnv& all, const Field<T> (&fields)[kRows], const T& object) {
    for (const Field<T>& field : fields) {
        if (!field.in(Files::kRecord)) continue;  // a record from a file gives the same picture
        const FieldValue value = field.value(object);
        all.add(std::uint64_t{value.index()});
        if (const auto* number = std::get_if<double>(&value)) all.add(*number);
        if (const auto* whole = std::get_if<std::int64_t>(&value))
            all.add(static_cast<std::uint64_t>(*whole));
        if (const auto* text = std::get_if<std::string>(&value)) add_text(all, *text);
        if (const auto* list = std::get_if<std::vector<double>>(&value))
            for (const double x : *list) all.add(x);
    }
}

template <class T, std::size_t kRows>
void add_rows(Fnv& all, const Field<T> (&fields)[kRows], const std::vector<T>& objects) {
    all.add(std::uint64_t{objects.size()});
    for (const T& object : objects) add_rows(all, fields, object);
}

}  // namespace

std::string picture_of(const Record& record, const SequenceOptions& options) {
    Fnv all;
    all.add(record.hash());
    all.add(record.gravity);
    add_rows(all, kTableFields, record.table);
    add_rows(all, kCushionFields, record.table.cushions);
    add_rows(all, kJawFields, record.table.jaws);
    add_rows(all, kPocketFields, record.table.pockets);
    add_rows(all, kBallFields, record.balls);
    for (const BallTrack& track : record.tracks) {
        add_text(all, track.id);
        add_rows(all, kSizeFields, track.own.value_or(record.balls.size()));
    }
    all.add(options.view.fov_deg);
    if (options.overlay.margin) all.add(options.fps);
    for (const int x : {options.size.width, options.size.height, options.table_samples})
        all.add(static_cast<std::uint64_t>(x));
    for (const std::optional<Vec3>& point : {options.view.eye, options.view.target}) {
        all.add(std::uint64_t{point.has_value()});
        for (int k = 0; point && k < 3; ++k) all.add((*point)[k]);
    }
    const Overlay& o = options.overlay;
    for (const bool drawn : {o.trails, o.ball_trails, o.events, o.spin, o.ghost, o.clock, o.margin})
        all.add(std::uint64_t{drawn});
    add_text(all, options.camera);
    add_text(all, options.view.ball);
    std::array<char, 17> digits{};
    std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(all.value()));
    return digits.data();
}

std::string mark_at(const std::string& picture, double time) {
    std::array<char, kMark + 1> text{};
    std::snprintf(text.data(), text.size(), "%s at %24.17g s", picture.c_str(), time);
    return text.data();
}

void add_mark(std::vector<std::uint8_t>& png, const std::string& mark) {
    const std::string tail = tail_of(mark);
    png.resize(png.size() - kEnd.size());
    png.insert(png.end(), tail.begin(), tail.end());
}

std::string mark_of(const std::string& path) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
    std::string head(kSignature.size(), '\0'), tail(8 + kText + kEnd.size(), '\0');
    if (!file || std::fread(head.data(), 1, head.size(), file.get()) != head.size() || head != kSignature ||
        std::fseek(file.get(), -static_cast<long>(tail.size()), SEEK_END) != 0 ||
        std::fread(tail.data(), 1, tail.size(), file.get()) != tail.size())
        return "";
    std::string mark = tail.substr(4 + kBefore.size(), kMark);
    return tail == tail_of(mark) ? mark : "";
}

}  // namespace carom::render
