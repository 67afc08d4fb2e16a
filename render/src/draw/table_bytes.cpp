#include "carom/render/table_bytes.h"

#include <cstddef>
#include <cstdint>
#include <vector>

#include "draw/table_parts.h"
#include "font/glyphs.h"

namespace carom::render {

std::string table_bytes(const TableMesh& table) {
    const TableParts parts = sort_parts(table, {});
    std::vector<float> numbers{static_cast<float>(table.origin.x()), static_cast<float>(table.origin.y())};
    for (const std::size_t end : parts.ends) numbers.push_back(static_cast<float>(end));
    static_assert(sizeof(PartVertex) == 10 * sizeof(float));
    std::string bytes(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float));
    bytes.append(reinterpret_cast<const char*>(parts.vertices.data()),
                 parts.vertices.size() * sizeof(PartVertex));
    const std::vector<std::uint8_t>& atlas = glyph_atlas();
    return bytes.append(atlas.begin(), atlas.end());
}

}  // namespace carom::render
