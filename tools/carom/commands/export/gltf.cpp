#include "commands/export/gltf.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace carom::tools {
namespace {

// Constants of the glTF specification.
constexpr int kFloat = 5126, kUnsignedShort = 5123, kUnsignedInt = 5125, kIndices = 34963;
constexpr std::size_t kAlign = 4;

std::size_t components(std::string_view type) {
    return type == "SCALAR" ? 1 : static_cast<std::size_t>(type.back() - '0');
}

/// Appends a number with its lowest byte first, on any machine.
void append_u32(std::string& out, std::size_t value) {
    for (int byte = 0; byte < 4; ++byte) out += static_cast<char>((value >> (8 * byte)) & 0xFFU);
}

void append_chunk(std::string& out, std::string_view content, std::string_view type, char filler) {
    const std::size_t padded = (content.size() + kAlign - 1) / kAlign * kAlign;
    append_u32(out, padded);
    out += type;
    out += content;
    out.append(padded - content.size(), filler);
}

}  // namespace

Gltf::Gltf(const std::string& generator) : json_{{"asset", {{"version", "2.0"}, {"generator", generator}}}} {}

std::size_t Gltf::add(const char* list, Json object) {
    Json& all = json_[list];
    all.push_back(std::move(object));
    return all.size() - 1;
}

std::size_t Gltf::add_view(const void* data, std::size_t size, int target) {
    binary_.resize((binary_.size() + kAlign - 1) / kAlign * kAlign, '\0');
    Json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", size}};
    if (target != 0) view["target"] = target;
    // The file is little-endian, like every machine this program is built for.
    binary_.append(static_cast<const char*>(data), size);
    return add("bufferViews", std::move(view));
}

std::size_t Gltf::add_floats(const std::vector<float>& values, const char* type, int target) {
    const std::size_t width = components(type);
    Json low = Json::array(), high = Json::array();
    for (std::size_t k = 0; k < width; ++k) {
        float least = values[k], most = values[k];
        for (std::size_t i = k; i < values.size(); i += width) {
            least = std::min(least, values[i]);
            most = std::max(most, values[i]);
        }
        low.push_back(least);
        high.push_back(most);
    }
    const std::size_t view = add_view(values.data(), values.size() * sizeof(float), target);
    return add("accessors", {{"bufferView", view},
                             {"componentType", kFloat},
                             {"count", values.size() / width},
                             {"type", type},
                             {"min", low},
                             {"max", high}});
}

std::size_t Gltf::add_indices(const std::vector<std::uint32_t>& indices) {
    const bool small = *std::max_element(indices.begin(), indices.end()) < 0xFFFFU;
    std::vector<std::uint16_t> shorts;
    if (small) shorts.assign(indices.begin(), indices.end());
    const std::size_t view = small ? add_view(shorts.data(), shorts.size() * sizeof(shorts[0]), kIndices)
                                   : add_view(indices.data(), indices.size() * sizeof(indices[0]), kIndices);
    return add("accessors", {{"bufferView", view},
                             {"componentType", small ? kUnsignedShort : kUnsignedInt},
                             {"count", indices.size()},
                             {"type", "SCALAR"}});
}

std::size_t Gltf::add_png(const std::vector<std::uint8_t>& png) {
    const std::size_t view = add_view(png.data(), png.size(), 0);
    const std::size_t image = add("images", {{"bufferView", view}, {"mimeType", "image/png"}});
    return add("textures", {{"source", image}});
}

std::string Gltf::bytes() const {
    Json json = json_;
    json["buffers"] = {{{"byteLength", binary_.size()}}};
    const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    std::string chunks;
    append_chunk(chunks, text, "JSON", ' ');
    append_chunk(chunks, binary_, std::string_view("BIN\0", 4), '\0');
    constexpr std::size_t kHeader = 12, kVersion = 2;
    std::string out = "glTF";
    append_u32(out, kVersion);
    append_u32(out, kHeader + chunks.size());
    return out + chunks;
}

}  // namespace carom::tools
