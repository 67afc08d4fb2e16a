#include <array>
#include <span>

#include "carom/games/rules.h"
#include "carom/interface/shape.h"

namespace carom::interface {

std::span<const Shape* const> types() {
    static const std::array kTypes = {
        &shape_of<games::State>(),      &shape_of<games::Call>(),       &shape_of<games::Legal>(),
        &shape_of<games::CalledFoul>(), &shape_of<games::Respot>(),     &shape_of<games::Option>(),
        &shape_of<games::Verdict>(),    &shape_of<games::RuleOption>(), &shape_of<games::GameInfo>(),
    };
    return kTypes;
}

}  // namespace carom::interface
