// The list of cushion models. Each is a file beside this one, with its row.
#include "carom/engine/cushion.h"

#include <span>
#include <string_view>

namespace carom {

extern const CushionModelInfo kStronge, kImpulse;

std::span<const CushionModelInfo* const> all_of(const CushionModelInfo*) {
    static constexpr const CushionModelInfo* kModels[] = {&kHan2005, &kMathavan2010, &kStronge, &kImpulse,
                                                          &kSmooth};
    return kModels;
}

const char* name(const CushionModelInfo* model) {
    return model->name;
}

const CushionModelInfo* cushion_model(std::string_view name) {
    for (const CushionModelInfo* model : all_of(&kHan2005))
        if (name == model->name) return model;
    return nullptr;
}

}  // namespace carom
