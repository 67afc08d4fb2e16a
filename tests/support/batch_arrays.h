// Impacts as the structure of arrays that collide_balls_batch takes, and back.
#pragma once

#include <vector>

#include "carom/kernel/batch.h"
#include "support/random_impacts.h"

namespace carom::test {

class BatchArrays {
  public:
    explicit BatchArrays(const std::vector<Impact>& impacts, kernel::ClothSlip slip)
        : count_(impacts.size()), data_(36 * count_), steps_(count_, -7), status_(count_) {
        batch.count = count_;
        batch.cloth_slip = slip;
        std::size_t column = 0;
        const auto put = [&](const double*& to, auto get) {
            double* at = data_.data() + count_ * column++;
            for (std::size_t i = 0; i < count_; ++i) at[i] = get(impacts[i]);
            to = at;
        };
        for (std::size_t k = 0; k < 3; ++k) {
            put(batch.r1[k], [k](const Impact& i) { return i.ball1.r[k]; });
            put(batch.v1[k], [k](const Impact& i) { return i.ball1.v[k]; });
            put(batch.w1[k], [k](const Impact& i) { return i.ball1.w[k]; });
            put(batch.r2[k], [k](const Impact& i) { return i.ball2.r[k]; });
            put(batch.v2[k], [k](const Impact& i) { return i.ball2.v[k]; });
            put(batch.w2[k], [k](const Impact& i) { return i.ball2.w[k]; });
            for (double** to : {&result.v1[k], &result.w1[k], &result.v2[k], &result.w2[k]})
                *to = data_.data() + count_ * column++;
        }
        put(batch.R, [](const Impact& i) { return i.params.R; });
        put(batch.m, [](const Impact& i) { return i.params.m; });
        put(batch.mu_s1, [](const Impact& i) { return i.params.mu_s1; });
        put(batch.mu_s2, [](const Impact& i) { return i.params.mu_s2; });
        put(batch.mu_b, [](const Impact& i) { return i.params.mu_b; });
        put(batch.e_b, [](const Impact& i) { return i.params.e_b; });
        result.steps = steps_.data();
        result.status = status_.data();
    }
    BatchArrays(const BatchArrays&) = delete;
    BatchArrays& operator=(const BatchArrays&) = delete;

    kernel::ImpactResult get(std::size_t i) const {
        kernel::ImpactResult out{};
        for (int k = 0; k < 3; ++k) {
            out.v1[k] = result.v1[k][i];
            out.w1[k] = result.w1[k][i];
            out.v2[k] = result.v2[k][i];
            out.w2[k] = result.w2[k][i];
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
    std::vector<long> steps_;
    std::vector<kernel::ImpactStatus> status_;
};

}  // namespace carom::test
