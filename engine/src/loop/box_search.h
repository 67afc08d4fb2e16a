// Finds the boxes that overlap a box. Boxes are in single precision and rounded outward: they only exclude pairs, and
// the remaining pairs are decided in double precision. The search is either one loop over all boxes, four at a time,
// or Box2D's dynamic tree, whose leaves are blocks of 64 neighbouring boxes, followed by that loop inside the blocks.
// Both find the same set.
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

/// [-] Relative margin of the boxes that exclude distant balls and parts of the table: it covers rounding.
inline constexpr double kBoxShare = 1e-9;

/// A rectangle on the table [m].
struct Box {
    double low_x, low_y, high_x, high_y;
};

/// A box in the form in which boxes are compared.
struct RoundedBox {
    float low_x, low_y, high_x, high_y;
};

class BoxSearch {
  public:
    static RoundedBox outward(const Box& box);
    /// Boxes are not found until they are placed.
    void set_up(int count, Search kind);

    void place(int index, const Box& box) { place(index, outward(box)); }
    void place(int index, const RoundedBox& box);
    void remove(int index);
    /// Call between placing and searching: from time to time it forms the blocks again from the present neighbours.
    void settle() {
        if (tree_ && --until_rebuild_ <= 0) rebuild();
    }

    /// Calls found(index) for every placed box that overlaps or touches `box`, in the order of the indices unless
    /// the search uses the tree.
    template <class Found>
    void overlapping(const Box& box, Found found) const {
        search(outward(box), found);
    }
    template <class Found>
    void overlapping(const RoundedBox& box, Found found) const {
        search(box, found);
    }
    /// The same for a placed box, which is not found itself.
    template <class Found>
    void neighbours(int index, Found found) const {
        search(at(slot(index)), [index, &found](int other) {
            if (other != index) found(other);
        });
    }

  private:
    static constexpr std::size_t kGroup = 4;   // [-] boxes that are compared at once
    static constexpr std::size_t kBlock = 64;  // [-] boxes per block
    using Rounded = RoundedBox;
    using Four = std::array<float, kGroup>;
    struct alignas(16) Group {
        Four low_x, low_y, high_x, high_y;
    };
    static b2AABB aabb_of(const Rounded& box);
    std::size_t slot(int index) const {
        const auto i = static_cast<std::size_t>(index);
        return tree_ ? static_cast<std::size_t>(slot_[i]) : i;
    }
    Rounded at(std::size_t slot) const {
        const Group& g = groups_[slot / kGroup];
        const std::size_t k = slot % kGroup;
        return {g.low_x[k], g.low_y[k], g.high_x[k], g.high_y[k]};
    }
    void set(std::size_t slot, const Rounded& box);
    void rebuild();
    void update_block(std::size_t block);

    template <class Found>
    void search(const Rounded& box, Found found) const;
    template <class Found>
    void scan(std::size_t begin, std::size_t end, const Rounded& box, Found& found) const;

    template <class Found>
    struct BlockVisitor {
        const BoxSearch& boxes;
        const Rounded& box;
        Found& found;
        bool QueryCallback(int proxy);  // the name that Box2D requires
    };

    // The boxes by slot, padded with some that overlap nothing.
    std::vector<Group> groups_;
    // With the tree: the slot of each box, the box in each slot, and the proxy of each block of slots.
    std::unique_ptr<b2DynamicTree> tree_;
    std::vector<int> slot_, index_, proxy_;
    std::vector<Rounded> sorted_;
    long until_rebuild_ = 0;
};

template <class Found>
bool BoxSearch::BlockVisitor<Found>::QueryCallback(int proxy) {
    const auto block = reinterpret_cast<std::uintptr_t>(boxes.tree_->GetUserData(proxy));
    auto by_slot = [this](int slot) { found(boxes.index_[slot]); };
    boxes.scan(block * (kBlock / kGroup), (block + 1) * (kBlock / kGroup), box, by_slot);
    return true;
}

template <class Found>
void BoxSearch::search(const Rounded& box, Found found) const {
    if (!tree_) {
        scan(0, groups_.size(), box, found);
        return;
    }
    BlockVisitor<Found> visitor{*this, box, found};
    tree_->Query(&visitor, aabb_of(box));
}

template <class Found>
void BoxSearch::scan(std::size_t begin, std::size_t end, const Rounded& box, Found& found) const {
    const Group* const groups = groups_.data();
#if defined(__SSE2__)
    const __m128 lx = _mm_set1_ps(box.low_x), ly = _mm_set1_ps(box.low_y);
    const __m128 hx = _mm_set1_ps(box.high_x), hy = _mm_set1_ps(box.high_y);
    for (std::size_t i = begin; i < end; ++i) {
        const Group& g = groups[i];
        const __m128 in_x = _mm_and_ps(_mm_cmple_ps(_mm_load_ps(g.low_x.data()), hx),
                                       _mm_cmple_ps(lx, _mm_load_ps(g.high_x.data())));
        const __m128 in_y = _mm_and_ps(_mm_cmple_ps(_mm_load_ps(g.low_y.data()), hy),
                                       _mm_cmple_ps(ly, _mm_load_ps(g.high_y.data())));
        for (auto mask = static_cast<unsigned>(_mm_movemask_ps(_mm_and_ps(in_x, in_y))); mask != 0;
             mask &= mask - 1)
            found(static_cast<int>(i * kGroup) + __builtin_ctz(mask));
    }
#else
    for (std::size_t i = begin; i < end; ++i) {
        const Group& g = groups[i];
        for (std::size_t k = 0; k < kGroup; ++k)
            if (g.low_x[k] <= box.high_x && box.low_x <= g.high_x[k] && g.low_y[k] <= box.high_y &&
                box.low_y <= g.high_y[k])
                found(static_cast<int>(i * kGroup + k));
    }
#endif
}

}  // namespace carom
