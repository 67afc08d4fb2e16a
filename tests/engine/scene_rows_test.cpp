// Every member of a struct that a scene describes has a row, or is named here as one that no file has: a new
// member breaks the build until it has one or the other.
#include <gtest/gtest.h>

#include <cstddef>
#include <optional>
#include <set>
#include <utility>

#include "carom/engine/scene.h"

namespace carom {

/// Converts to any type in an initializer.
struct Anything {
    template <class T>
    requires(!detail::kIsOptional<T>) operator T() const;  // NOLINT: the conversion is what it is for
};

namespace {

template <class T, std::size_t... kFirst, std::size_t... kOptional>
constexpr bool has_members(std::index_sequence<kFirst...>, std::index_sequence<kOptional...>) {
    return requires {
        T{(void(kFirst), Anything())..., (void(kOptional), std::nullopt)...};
    };
}

/// Members of an aggregate. Optional Eigen vectors must come last, and their number must be given.
template <class T, std::size_t kOptional = 0, std::size_t kMost = 24>
constexpr std::size_t members() {
    if constexpr (has_members<T>(std::make_index_sequence<kMost>(), std::make_index_sequence<kOptional>()))
        return kMost + kOptional;
    else
        return members<T, kOptional, kMost - 1>();
}

template <class T, std::size_t kRows>
constexpr std::size_t in_rows(const Field<T> (&fields)[kRows]) {
    std::size_t count = 0;
    for (const Field<T>& f : fields) count += static_cast<std::size_t>(f.members);
    return count;
}

static_assert(members<BallSize>() == in_rows(kSizeFields));
static_assert(members<BallParams>() == in_rows(kBallFields));
static_assert(members<BallStart>() == in_rows(kBallStartFields) + 2);  // where; own: kSizeFields
static_assert(members<Rack, 2>() == in_rows(kRackFields) + in_rows(kRackedBallFields));
static_assert(members<Cue>() == in_rows(kCueFields) + 1);  // where
static_assert(members<Physics>() == in_rows(kPhysicsFields));
static_assert(members<Stop>() == in_rows(kStopFields));
static_assert(members<RenderSettings, 2>() == in_rows(kRenderFields));
static_assert(members<Cushion>() == in_rows(kCushionFields));
static_assert(members<Jaw>() == in_rows(kJawFields));
static_assert(members<Pocket>() == in_rows(kPocketFields));
static_assert(members<Table, 1>() == in_rows(kTableFields) + 4);  // the lists; measures
static_assert(members<PocketMeasures>() == in_rows(kPocketMeasureFields));
static_assert(members<Measures, 1>() == in_rows(kMeasureFields) + 2);  // both kinds of pocket

// A row is found by its key.
TEST(Rows, KeysOfASectionDiffer) {
    const auto expect_distinct = [](const auto& fields) {
        for (const Files files : {Files::kScene, Files::kRecord}) {
            const auto keys = keys_of(fields, files);
            EXPECT_EQ(std::set(keys.begin(), keys.end()).size(), keys.size());
        }
    };
    expect_distinct(kBallFields);
    expect_distinct(kBallStartFields);
    expect_distinct(kRackFields);
    expect_distinct(kCueFields);
    expect_distinct(kPhysicsFields);
    expect_distinct(kRenderFields);
    expect_distinct(kTableFields);
    expect_distinct(kPocketMeasureFields);
}

}  // namespace
}  // namespace carom
