// Converts impacts into the structure of arrays of the batch kernels, and their results back.
#pragma once

#include <cstdint>
#include <vector>

#include "carom/kernel/batch.h"
#include "reference/random_impacts.h"

namespace carom::reference {

class BatchArrays {
  public:
    explicit BatchArrays(const std::vector<Impact>& impacts, kernel::ClothSlip slip)
        : count_(impacts.size()), data_(36 * count_), steps_(count_, -7), status_(count_) {
        batch.count = static_cast<std::int64_t>(count_);
        batch.params.cloth_slip = slip;
        std::size_t column = 0;
        const auto put = [&](const double*& to, auto get) {
            double* at = data_.data() + count_ * column++;
            for (std::size_t i = 0; i < count_; ++i) at[i] = get(impacts[i]);
            to = at;
        };
        for (std::size_t k = 0; k < 3; ++k) {
            put(batch.ball1.r[k], [k](const Impact& i) { return i.ball1.r[k]; });
            put(batch.ball1.v[k], [k](const Impact& i) { return i.ball1.v[k]; });
            put(batch.ball1.w[k], [k](const Impact& i) { return i.ball1.w[k]; });
            put(batch.ball2.r[k], [k](const Impact& i) { return i.ball2.r[k]; });
            put(batch.ball2.v[k], [k](const Impact& i) { return i.ball2.v[k]; });
            put(batch.ball2.w[k], [k](const Impact& i) { return i.ball2.w[k]; });
            for (double** to :
                 {&result.ball1.v[k], &result.ball1.w[k], &result.ball2.v[k], &result.ball2.w[k]})
                *to = data_.data() + count_ * column++;
        }
        put(batch.params.R, [](const Impact& i) { return i.params.R; });
        put(batch.params.m, [](const Impact& i) { return i.params.m; });
        put(batch.params.mu_s1, [](const Impact& i) { return i.params.mu_s1; });
        put(batch.params.mu_s2, [](const Impact& i) { return i.params.mu_s2; });
        put(batch.params.mu_b, [](const Impact& i) { return i.params.mu_b; });
        put(batch.params.e_b, [](const Impact& i) { return i.params.e_b; });
        result.steps = steps_.data();
        result.status = status_.data();
    }
    BatchArrays(const BatchArrays&) = delete;
    BatchArrays& operator=(const BatchArrays&) = delete;

    kernel::ImpactResult get(std::size_t i) const {
        kernel::ImpactResult out{};
        for (int k = 0; k < 3; ++k) {
            out.v1[k] = result.ball1.v[k][i];
            out.w1[k] = result.ball1.w[k][i];
            out.v2[k] = result.ball2.v[k][i];
            out.w2[k] = result.ball2.w[k][i];
        }
        out.steps = steps_[i];
        out.status = status_[i];
        return out;
    }

    kernel::ImpactBatch batch{};
    kernel::ImpactBatchResult result{};

  private:
    std::size_t count_;
    std::vector<double> data_;
    std::vector<std::int64_t> steps_;
    std::vector<kernel::ImpactStatus> status_;
};

}  // namespace carom::reference
