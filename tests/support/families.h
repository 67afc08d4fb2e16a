// A table of seeded scene families: one row each, with its name.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <span>
#include <string_view>

namespace carom::test {

template <const auto& kRows>
std::span<const char* const> names_of() {
    static const auto names = [] {
        std::array<const char*, std::size(kRows)> list{};
        std::transform(std::begin(kRows), std::end(kRows), list.begin(),
                       [](const auto& row) { return row.name; });
        return list;
    }();
    return names;
}

/// The row with this name, or nullptr.
template <class Row, std::size_t kCount>
const Row* row_of(const Row (&rows)[kCount], std::string_view name) {
    const Row* row = std::find_if(rows, rows + kCount, [&](const Row& r) { return r.name == name; });
    return row == rows + kCount ? nullptr : row;
}

}  // namespace carom::test
