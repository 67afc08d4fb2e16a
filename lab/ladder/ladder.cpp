#include "ladder/ladder.h"

#include <cstring>
#include <vector>

#include "ladder/rungs.h"

namespace carom::kernel {

std::span<const Rung> ladder() noexcept {
    static const std::vector<Rung> kAll = [] {
#if defined(__x86_64__)
        const std::vector<std::span<const Rung>> sets = {scalar::kRungs, v3::kRungs, v4::kRungs};
#else
        const std::vector<std::span<const Rung>> sets = {scalar::kRungs};
#endif
        std::vector<Rung> all;
        for (const Rung& form : sets.back())  // the widest instruction set has every variant
            for (const auto& rungs : sets)
                for (const Rung& rung : rungs)
                    if (std::strcmp(rung.name, form.name) == 0) all.push_back(rung);
        return all;
    }();
    return kAll;
}

}  // namespace carom::kernel
