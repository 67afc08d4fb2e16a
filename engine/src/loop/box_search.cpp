#include "loop/box_search.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace carom {

namespace {

// [1/m] Box2D enlarges its boxes by 0.1 units: 1 mm with a unit of one centimetre.
constexpr double kUnitsPerMetre = 100.0;
// [units] Far beyond any table, and small enough that sums and products of a few do not overflow single
// precision.
constexpr double kFarthest = 1e15;
// [-] Margin of the conversion to float, whose relative error is at most 2^-24.
constexpr double kOutward = 0x1p-23;

double scaled(double x) {
    return std::clamp(x * kUnitsPerMetre, -kFarthest, kFarthest);
}
float down(double x) {
    const double y = scaled(x);
    return static_cast<float>(y - kOutward * std::abs(y));
}
float up(double x) {
    const double y = scaled(x);
    return static_cast<float>(y + kOutward * std::abs(y));
}

// [-] Margin of a block's box in the tree, as a fraction of its circumference.
constexpr float kBlockMargin = 0.05f;
// [-] Searches per box before the blocks are rebuilt: sorting costs about 100 ns per box.
constexpr std::int64_t kSearchesPerBox = 4;

constexpr float kNowhere = std::numeric_limits<float>::infinity();  // bound of unplaced boxes

}  // namespace

RoundedBox BoxSearch::outward(const Box& box) {
    return {down(box.low_x), down(box.low_y), up(box.high_x), up(box.high_y)};
}

b2AABB BoxSearch::aabb_of(const Rounded& box) {
    b2AABB aabb;
    aabb.lowerBound.Set(box.low_x, box.low_y);
    aabb.upperBound.Set(box.high_x, box.high_y);
    return aabb;
}

void BoxSearch::set_up(int count, Search kind) {
    const auto boxes = static_cast<std::size_t>(count);
    const std::size_t whole = kind == Search::kTree ? kBlock : kRow;
    const std::size_t size = (boxes + whole - 1) / whole * whole;
    Row nowhere{};
    for (Bounds* low : {&nowhere.low_x, &nowhere.low_y}) low->fill(kNowhere);
    for (Bounds* high : {&nowhere.high_x, &nowhere.high_y}) high->fill(-kNowhere);
    rows_.assign(size / kRow, nowhere);
    tree_.reset();
    if (kind != Search::kTree) return;
    tree_ = std::make_unique<b2DynamicTree>();
    slot_.resize(boxes);
    index_.assign(size, -1);
    sorted_.resize(boxes);
    proxy_.assign(size / kBlock, -1);
    around_.resize(size / kBlock);
    for (std::size_t i = 0; i < boxes; ++i) slot_[i] = index_[i] = static_cast<int>(i);
    until_rebuild_ = 0;
}

void BoxSearch::set(std::size_t slot, const Rounded& box) {
    Row& row = rows_[slot / kRow];
    const std::size_t k = slot % kRow;
    row.low_x[k] = box.low_x;
    row.low_y[k] = box.low_y;
    row.high_x[k] = box.high_x;
    row.high_y[k] = box.high_y;
}

void BoxSearch::surround(std::size_t slot, const Rounded& box) {
    Around& around = around_[slot / kBlock];
    const std::size_t k = slot % kBlock / kRow;
    around.low_x[k] = std::min(around.low_x[k], box.low_x);
    around.low_y[k] = std::min(around.low_y[k], box.low_y);
    around.high_x[k] = std::max(around.high_x[k], box.high_x);
    around.high_y[k] = std::max(around.high_y[k], box.high_y);
}

void BoxSearch::place(int index, const RoundedBox& rounded) {
    const std::size_t s = slot(index);
    set(s, rounded);
    if (tree_) surround(s, rounded);
    if (!tree_ || proxy_[s / kBlock] < 0) return;  // no blocks exist before the first build
    if (!tree_->GetFatAABB(proxy_[s / kBlock]).Contains(aabb_of(rounded))) update_block(s / kBlock);
}

void BoxSearch::remove(int index) {
    set(slot(index), {kNowhere, kNowhere, -kNowhere, -kNowhere});
}

// Updates the tree's box of a block, with a margin for motion.
void BoxSearch::update_block(std::size_t block) {
    Rounded around{kNowhere, kNowhere, -kNowhere, -kNowhere};
    for (auto* low : {&around_[block].low_x, &around_[block].low_y}) low->fill(kNowhere);
    for (auto* high : {&around_[block].high_x, &around_[block].high_y}) high->fill(-kNowhere);
    for (std::size_t i = block * kBlock; i < (block + 1) * kBlock; ++i) {
        const Rounded box = at(i);
        surround(i, box);
        around.low_x = std::min(around.low_x, box.low_x);
        around.low_y = std::min(around.low_y, box.low_y);
        around.high_x = std::max(around.high_x, box.high_x);
        around.high_y = std::max(around.high_y, box.high_y);
    }
    if (around.low_x > around.high_x) return;  // the block is empty
    b2AABB aabb = aabb_of(around);
    const float margin = kBlockMargin * (around.high_x - around.low_x + around.high_y - around.low_y);
    aabb.lowerBound -= b2Vec2(margin, margin);
    aabb.upperBound += b2Vec2(margin, margin);
    tree_->MoveProxy(proxy_[block], aabb, b2Vec2(0.0f, 0.0f));
}

// Forms blocks of neighbours: strips with equal numbers of boxes, sorted by x, and within a strip by y.
void BoxSearch::rebuild() {
    const std::size_t count = slot_.size(), blocks = proxy_.size();
    for (std::size_t i = 0; i < count; ++i) sorted_[i] = at(static_cast<std::size_t>(slot_[i]));
    const auto by = [this](auto middle) {
        return [this, middle](int i, int j) {
            const float p = middle(sorted_[i]), q = middle(sorted_[j]);
            return p < q || (p == q && i < j);
        };
    };
    // The sum of a removed box is infinity - infinity. Its position in the order is irrelevant, but NaN must
    // not be compared.
    const auto finite = [](float sum) { return sum == sum ? sum : 0.0f; };
    const auto middle_x = [finite](const Rounded& r) { return finite(r.low_x + r.high_x); };
    const auto middle_y = [finite](const Rounded& r) { return finite(r.low_y + r.high_y); };
    std::size_t strips = 1;
    while (strips * strips < blocks) ++strips;
    const std::size_t strip = (blocks + strips - 1) / strips * kBlock;
    std::sort(index_.begin(), index_.begin() + static_cast<std::ptrdiff_t>(count), by(middle_x));
    for (std::size_t begin = 0; begin < count; begin += strip)
        std::sort(index_.begin() + static_cast<std::ptrdiff_t>(begin),
                  index_.begin() + static_cast<std::ptrdiff_t>(std::min(begin + strip, count)), by(middle_y));
    for (std::size_t s = 0; s < count; ++s) {
        const auto i = static_cast<std::size_t>(index_[s]);
        slot_[i] = static_cast<int>(s);
        set(s, sorted_[i]);
    }
    for (std::size_t b = 0; b < blocks; ++b) {
        if (proxy_[b] < 0) {
            const b2AABB nothing{b2Vec2(0.0f, 0.0f), b2Vec2(0.0f, 0.0f)};
            // The user pointer of the tree stores the block's number, and is never dereferenced.
            void* block = reinterpret_cast<void*>(b);  // NOLINT(performance-no-int-to-ptr): see above
            proxy_[b] = tree_->CreateProxy(nothing, block);
        }
        update_block(b);
    }
    until_rebuild_ = kSearchesPerBox * static_cast<std::int64_t>(count);
}

}  // namespace carom
