#include "box_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

// Box2D fattens its boxes by 0.1 units: of a centimetre, that is little.
constexpr double kUnitsPerMetre = 100.0;
// [units] Beyond every table; sums and products of a few stay far from overflow in single precision.
constexpr double kFarthest = 1e15;
// Conversion to float errs by at most 2^-24 of the value.
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

constexpr float kNowhere = std::numeric_limits<float>::infinity();

}  // namespace

BoxSearch::Rounded BoxSearch::outward(const Box& box) {
    return {down(box.low_x), down(box.low_y), up(box.high_x), up(box.high_y)};
}

void BoxSearch::set_up(int count, Search kind) {
    const std::size_t size = (static_cast<std::size_t>(count) + 3) / 4 * 4;
    for (std::vector<float>* low : {&low_x_, &low_y_}) low->assign(size, kNowhere);
    for (std::vector<float>* high : {&high_x_, &high_y_}) high->assign(size, -kNowhere);
    tree_.reset();
    if (kind != Search::kTree) return;
    tree_ = std::make_unique<b2DynamicTree>();
    proxy_.assign(static_cast<std::size_t>(count), -1);
}

void BoxSearch::place(int index, const Box& box) {
    const auto i = static_cast<std::size_t>(index);
    const Rounded r = outward(box);
    low_x_[i] = r.low_x;
    low_y_[i] = r.low_y;
    high_x_[i] = r.high_x;
    high_y_[i] = r.high_y;
    if (!tree_) return;
    b2AABB aabb;
    aabb.lowerBound.Set(r.low_x, r.low_y);
    aabb.upperBound.Set(r.high_x, r.high_y);
    if (proxy_[i] < 0)
        proxy_[i] = tree_->CreateProxy(aabb, reinterpret_cast<void*>(static_cast<std::intptr_t>(index)));
    else
        tree_->MoveProxy(proxy_[i], aabb, b2Vec2(0.0f, 0.0f));
}

void BoxSearch::remove(int index) {
    const auto i = static_cast<std::size_t>(index);
    low_x_[i] = low_y_[i] = kNowhere;
    high_x_[i] = high_y_[i] = -kNowhere;
    if (!tree_ || proxy_[i] < 0) return;
    tree_->DestroyProxy(proxy_[i]);
    proxy_[i] = -1;
}

}  // namespace carom
