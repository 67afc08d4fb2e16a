#include "ladder/ladder.h"

#include <cstring>
#include <vector>

#include "ladder/rungs.h"

namespace carom::kernel {

std::span<const Rung> ladder() noexcept {
    static const std::vector<Rung> kAll = [] {
        std::vector<Rung> all;
        for (const Rung& form : v4::kRungs)  // the widest instruction set has every variant
            for (const auto& rungs : {scalar::kRungs, v3::kRungs, v4::kRungs})
                for (const Rung& rung : rungs)
                    if (std::strcmp(rung.name, form.name) == 0) all.push_back(rung);
        return all;
    }();
    return kAll;
}

}  // namespace carom::kernel
