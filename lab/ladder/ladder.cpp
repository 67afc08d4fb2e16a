#include "ladder/ladder.h"

#include <cstring>
#include <vector>

#include "ladder/variants.h"

namespace carom::kernel {

std::span<const Variant> ladder() noexcept {
    static const std::vector<Variant> kAll = [] {
#if defined(__x86_64__)
        const std::vector<std::span<const Variant>> sets = {scalar::kVariants, v3::kVariants, v4::kVariants};
#else
        const std::vector<std::span<const Variant>> sets = {scalar::kVariants};
#endif
        std::vector<Variant> all;
        for (const Variant& form : sets.back())  // the widest instruction set has every variant
            for (const auto& variants : sets)
                for (const Variant& variant : variants)
                    if (std::strcmp(variant.name, form.name) == 0) all.push_back(variant);
        return all;
    }();
    return kAll;
}

}  // namespace carom::kernel
