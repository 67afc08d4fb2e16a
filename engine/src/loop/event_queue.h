// Finds the players with the earliest next event. Groups of sixteen times are compared without unpredictable
// branches. The earliest time of each group is an entry in the next level; the last level is one group.
// set_up() allocates all memory.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace carom {

class EventQueue {
  public:
    /// Starts with `count` players without events.
    void set_up(int count) {
        std::size_t levels = 0;
        auto size = static_cast<std::size_t>(count);
        do {
            const std::size_t groups = std::max<std::size_t>(1, (size + kGroup - 1) / kGroup);
            if (level_.size() == levels) level_.emplace_back();
            level_[levels++].assign(groups, Group());
            size = groups;
        } while (size > 1);
        level_.resize(levels);
    }

    /// Sets the time of player i's next event; infinite if there is none.
    void set(int i, double time) {
        auto place = static_cast<std::size_t>(i);
        for (std::size_t level = 0;; ++level) {
            Group& group = level_[level][place / kGroup];
            group.time[place % kGroup] = time;
            if (level + 1 == level_.size()) return;
            place /= kGroup;
            time = least(group);
            if (time == level_[level + 1][place / kGroup].time[place % kGroup]) return;
        }
    }

    double time(int i) const {
        const auto place = static_cast<std::size_t>(i);
        return level_[0][place / kGroup].time[place % kGroup];
    }

    /// The time of the first event; infinite if there is none.
    double first() const { return least(level_.back()[0]); }

    /// Calls found(player) for every player with this time, which must be first(), in the order of the
    /// players.
    template <class Found>
    void all_at(double first, Found found) const {
        descend(level_.size() - 1, 0, first, found);
    }

  private:
    static constexpr std::size_t kGroup = 16;  // [-] times compared at once
    struct alignas(64) Group {
        Group() { time.fill(std::numeric_limits<double>::infinity()); }
        std::array<double, kGroup> time;
    };

    static double least(const Group& group) {
        const auto& t = group.time;
#if defined(__SSE2__)
        __m128d a = _mm_load_pd(&t[0]), b = _mm_load_pd(&t[2]);
        for (std::size_t k = 4; k < kGroup; k += 4) {
            a = _mm_min_pd(a, _mm_load_pd(&t[k]));
            b = _mm_min_pd(b, _mm_load_pd(&t[k + 2]));
        }
        a = _mm_min_pd(a, b);
        return _mm_cvtsd_f64(_mm_min_sd(a, _mm_unpackhi_pd(a, a)));
#else
        return *std::min_element(t.begin(), t.end());
#endif
    }

    /// A bit for every time of the group that equals this one.
    static unsigned equal(const Group& group, double time) {
        unsigned mask = 0;
#if defined(__SSE2__)
        const __m128d asked = _mm_set1_pd(time);
        for (std::size_t k = 0; k < kGroup; k += 2)
            mask |= static_cast<unsigned>(_mm_movemask_pd(_mm_cmpeq_pd(_mm_load_pd(&group.time[k]), asked)))
                    << k;
#else
        for (std::size_t k = 0; k < kGroup; ++k) mask |= static_cast<unsigned>(group.time[k] == time) << k;
#endif
        return mask;
    }

    template <class Found>
    void descend(std::size_t level, std::size_t group, double first, Found& found) const {
        for (unsigned mask = equal(level_[level][group], first); mask != 0; mask &= mask - 1) {
            const std::size_t place = group * kGroup + static_cast<std::size_t>(__builtin_ctz(mask));
            if (level == 0)
                found(static_cast<int>(place));
            else
                descend(level - 1, place, first, found);
        }
    }

    std::vector<std::vector<Group>> level_;
};

}  // namespace carom
