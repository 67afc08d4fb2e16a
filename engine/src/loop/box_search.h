// Finds the boxes that overlap a box. Boxes are in single precision and rounded outward: they only exclude
// pairs; the remaining pairs are decided in double precision. The search is either a loop over all boxes,
// sixteen at a time, or Box2D's dynamic tree with blocks of 64 neighbouring boxes as leaves and that loop
// inside each block. Both find the same set.
#pragma once

#include <box2d/b2_dynamic_tree.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "carom/engine/plan.h"

namespace carom {

/// [-] Relative margin, for rounding, of the boxes that exclude distant balls and parts of the table.
inline constexpr double kBoxShare = 1e-9;

/// A rectangle on the table [m].
struct Box {
    double low_x, low_y, high_x, high_y;
};

inline Box box_around(const Vec2& center, double reach) {
    return {center.x() - reach, center.y() - reach, center.x() + reach, center.y() + reach};
}

/// A box, rounded for comparisons.
struct RoundedBox {
    float low_x, low_y, high_x, high_y;
};

class BoxSearch {
  public:
    static RoundedBox outward(const Box& box);
    /// A box is not found before it is placed.
    void set_up(int count, Search kind);

    void place(int index, const Box& box) { place(index, outward(box)); }
    void place(int index, const RoundedBox& box);
    void remove(int index);
    /// Call between placing and searching: it sometimes rebuilds the blocks from the present neighbours.
    void rebuild_if_due() {
        if (tree_ && --until_rebuild_ <= 0) rebuild();
    }

    /// Calls found(index) for every placed box that overlaps or touches `box`; without a tree, in index
    /// order.
    template <class Found>
    void overlapping(const Box& box, Found found) const {
        search(outward(box), found);
    }
    template <class Found>
    void overlapping(const RoundedBox& box, Found found) const {
        search(box, found);
    }
    /// The same for a placed box, excluding itself.
    template <class Found>
    void neighbours(int index, Found found) const {
        search(at(slot(index)), [index, &found](int other) {
            if (other != index) found(other);
        });
    }

  private:
    static constexpr std::size_t kRow = 16;    // [-] boxes compared at once
    static constexpr std::size_t kBlock = 64;  // [-] boxes per block
    using Rounded = RoundedBox;
    using Bounds = std::array<float, kRow>;
    struct alignas(64) Row {
        Bounds low_x, low_y, high_x, high_y;
    };
    // A box around each row of a block; only grows until the block's own box is renewed.
    struct alignas(64) Around {
        std::array<float, kBlock / kRow> low_x, low_y, high_x, high_y;
    };
    static b2AABB aabb_of(const Rounded& box);
    std::size_t slot(int index) const {
        const auto i = static_cast<std::size_t>(index);
        return tree_ ? static_cast<std::size_t>(slot_[i]) : i;
    }
    Rounded at(std::size_t slot) const {
        const Row& row = rows_[slot / kRow];
        const std::size_t k = slot % kRow;
        return {row.low_x[k], row.low_y[k], row.high_x[k], row.high_y[k]};
    }
    void set(std::size_t slot, const Rounded& box);
    void surround(std::size_t slot, const Rounded& box);
    void rebuild();
    void update_block(std::size_t block);

    template <class Found>
    void search(const Rounded& box, Found found) const;
    template <class Found>
    void scan(std::size_t begin, std::size_t end, const Rounded& box, Found& found) const;
    template <class Found>
    void scan_row(std::size_t row, const Rounded& box, Found& found) const;
#if defined(__SSE2__)
    template <class Boxes>
    static __m128 four(const Boxes& boxes, std::size_t k, const Rounded& box);
    static unsigned overlaps(const Row& row, const Rounded& box);
    static unsigned overlaps(const Around& around, const Rounded& box);
#else
    template <class Boxes>
    static unsigned overlaps(const Boxes& boxes, const Rounded& box);
#endif

    template <class Found>
    struct BlockVisitor {
        const BoxSearch& boxes;
        const Rounded& box;
        Found& found;
        bool QueryCallback(int proxy);  // the name that Box2D requires
    };

    // The boxes by slot, padded with boxes that overlap nothing.
    std::vector<Row> rows_;
    // With the tree: the slot of each box, the box in each slot, and the proxy of each block of slots.
    std::unique_ptr<b2DynamicTree> tree_;
    std::vector<int> slot_, index_, proxy_;
    std::vector<Around> around_;  // of each block
    std::vector<Rounded> sorted_;
    std::int64_t until_rebuild_ = 0;
};

template <class Found>
bool BoxSearch::BlockVisitor<Found>::QueryCallback(int proxy) {
    const auto block = reinterpret_cast<std::uintptr_t>(boxes.tree_->GetUserData(proxy));
    auto by_slot = [this](int slot) { found(boxes.index_[slot]); };
    for (unsigned mask = overlaps(boxes.around_[block], box); mask != 0; mask &= mask - 1)
        boxes.scan_row(block * (kBlock / kRow) + static_cast<unsigned>(__builtin_ctz(mask)), box, by_slot);
    return true;
}

template <class Found>
void BoxSearch::search(const Rounded& box, Found found) const {
    if (!tree_) {
        scan(0, rows_.size(), box, found);
        return;
    }
    BlockVisitor<Found> visitor{*this, box, found};
    tree_->Query(&visitor, aabb_of(box));
}

template <class Found>
void BoxSearch::scan(std::size_t begin, std::size_t end, const Rounded& box, Found& found) const {
    for (std::size_t row = begin; row < end; ++row) scan_row(row, box, found);
}

template <class Found>
void BoxSearch::scan_row(std::size_t row, const Rounded& box, Found& found) const {
    for (unsigned mask = overlaps(rows_[row], box); mask != 0; mask &= mask - 1)
        found(static_cast<int>(row * kRow) + __builtin_ctz(mask));
}

// A bit for every box of the rows that overlaps this one. Branchless, because the number of overlaps is
// unpredictable.
#if defined(__SSE2__)
template <class Boxes>
__m128 BoxSearch::four(const Boxes& boxes, std::size_t k, const Rounded& box) {
    const __m128 in_x = _mm_and_ps(_mm_cmple_ps(_mm_load_ps(&boxes.low_x[k]), _mm_set1_ps(box.high_x)),
                                   _mm_cmple_ps(_mm_set1_ps(box.low_x), _mm_load_ps(&boxes.high_x[k])));
    const __m128 in_y = _mm_and_ps(_mm_cmple_ps(_mm_load_ps(&boxes.low_y[k]), _mm_set1_ps(box.high_y)),
                                   _mm_cmple_ps(_mm_set1_ps(box.low_y), _mm_load_ps(&boxes.high_y[k])));
    return _mm_and_ps(in_x, in_y);
}

inline unsigned BoxSearch::overlaps(const Row& row, const Rounded& box) {
    const auto pair = [&](std::size_t k) {
        return _mm_packs_epi32(_mm_castps_si128(four(row, k, box)), _mm_castps_si128(four(row, k + 4, box)));
    };
    return static_cast<unsigned>(_mm_movemask_epi8(_mm_packs_epi16(pair(0), pair(8))));
}

inline unsigned BoxSearch::overlaps(const Around& around, const Rounded& box) {
    return static_cast<unsigned>(_mm_movemask_ps(four(around, 0, box)));
}
#else
template <class Boxes>
unsigned BoxSearch::overlaps(const Boxes& boxes, const Rounded& box) {
    unsigned mask = 0;
    for (std::size_t k = 0; k < boxes.low_x.size(); ++k)
        mask |= static_cast<unsigned>(boxes.low_x[k] <= box.high_x && box.low_x <= boxes.high_x[k] &&
                                      boxes.low_y[k] <= box.high_y && box.low_y <= boxes.high_y[k])
                << k;
    return mask;
}
#endif

}  // namespace carom
