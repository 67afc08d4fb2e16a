// Which boxes overlap a box? Boxes are in single precision, rounded outward: they only leave out, and what
// they leave in is judged in double. Either all of them one after another, four at a time, or in Box2D's
// dynamic tree; both give the same set.
#pragma once

#include <box2d/b2_dynamic_tree.h>

#include <cstdint>
#include <memory>
#include <vector>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "carom/engine/plan.h"

namespace carom {

/// A rectangle on the table [m].
struct Box {
    double low_x, low_y, high_x, high_y;
};

class BoxSearch {
  public:
    /// All boxes are out until they are placed.
    void set_up(int count, Search kind);

    void place(int index, const Box& box);
    void remove(int index);

    /// Calls found(index) for every placed box that overlaps or touches `box`; in the order of the indices
    /// unless the search is a tree.
    template <class Found>
    void overlapping(const Box& box, Found found) const {
        search(outward(box), found);
    }
    /// The same for a placed box; itself is not found.
    template <class Found>
    void neighbours(int index, Found found) const {
        const auto i = static_cast<std::size_t>(index);
        search({low_x_[i], low_y_[i], high_x_[i], high_y_[i]}, [index, &found](int other) {
            if (other != index) found(other);
        });
    }

  private:
    struct Rounded {
        float low_x, low_y, high_x, high_y;
    };
    template <class Found>
    void search(const Rounded& box, Found found) const;
    static Rounded outward(const Box& box);
    bool overlaps(int index, const Rounded& box) const {
        const auto i = static_cast<std::size_t>(index);
        return low_x_[i] <= box.high_x && box.low_x <= high_x_[i] && low_y_[i] <= box.high_y &&
               box.low_y <= high_y_[i];
    }

    template <class Found>
    struct TreeVisitor {
        const BoxSearch& search;
        const Rounded& box;
        Found& found;
        bool QueryCallback(int proxy);  // Box2D's name
    };

    // Padded to whole groups of four with boxes that overlap nothing.
    std::vector<float> low_x_, low_y_, high_x_, high_y_;
    std::unique_ptr<b2DynamicTree> tree_;
    std::vector<int> proxy_;  // -1: out
};

template <class Found>
bool BoxSearch::TreeVisitor<Found>::QueryCallback(int proxy) {
    // The tree keeps its boxes wider, so that small moves cost nothing.
    const int index = static_cast<int>(reinterpret_cast<std::intptr_t>(search.tree_->GetUserData(proxy)));
    if (search.overlaps(index, box)) found(index);
    return true;
}

template <class Found>
void BoxSearch::search(const Rounded& box, Found found) const {
    if (tree_) {
        TreeVisitor<Found> visitor{*this, box, found};
        b2AABB range;
        range.lowerBound.Set(box.low_x, box.low_y);
        range.upperBound.Set(box.high_x, box.high_y);
        tree_->Query(&visitor, range);
        return;
    }
#if defined(__SSE2__)
    const __m128 lx = _mm_set1_ps(box.low_x), ly = _mm_set1_ps(box.low_y);
    const __m128 hx = _mm_set1_ps(box.high_x), hy = _mm_set1_ps(box.high_y);
    for (std::size_t i = 0; i < low_x_.size(); i += 4) {
        const __m128 in_x = _mm_and_ps(_mm_cmple_ps(_mm_loadu_ps(&low_x_[i]), hx),
                                       _mm_cmple_ps(lx, _mm_loadu_ps(&high_x_[i])));
        const __m128 in_y = _mm_and_ps(_mm_cmple_ps(_mm_loadu_ps(&low_y_[i]), hy),
                                       _mm_cmple_ps(ly, _mm_loadu_ps(&high_y_[i])));
        for (auto mask = static_cast<unsigned>(_mm_movemask_ps(_mm_and_ps(in_x, in_y))); mask != 0;
             mask &= mask - 1)
            found(static_cast<int>(i) + __builtin_ctz(mask));
    }
#else
    for (std::size_t i = 0; i < low_x_.size(); ++i)
        if (overlaps(static_cast<int>(i), box)) found(static_cast<int>(i));
#endif
}

}  // namespace carom
