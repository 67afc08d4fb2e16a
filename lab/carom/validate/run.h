// Runs validation cases.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "carom/kernel/isa.h"
#include "validate/case.h"

namespace carom::tools {

/// One measured number under one variant. It refers to its case.
struct ValidationRow {
    const ValidationCase* of;
    const ValidationShot* shot;
    const Variant* variant;
    const Measured* measured;
    std::string model;    ///< that the case is about, as in the plan
    std::string differs;  ///< "mu_r = 1e-06": numbers of the balls that the shipped preset sets otherwise
    Claim claim;
    double computed;
    double sampled;  ///< standard deviation of `computed` for the number of shots that were played
    /// The uncertainty of the measured number, and 1.96 times `sampled`.
    double uncertainty;

    /// computed - measured, in units of the uncertainty
    double deviation() const;
    bool within() const;
    /// Whether the claim holds: within; or outside, and within a quarter of the uncertainty of the claimed
    /// value; or, for many shots, within three standard deviations of the claimed value.
    bool as_claimed() const;
};

/// Plays all shots of a case with all variants: rows by shot, number and variant. `progress` is called after
/// each run of the case with the number of runs so far.
/// @throws SceneError, std::runtime_error naming case, variant and shot
std::vector<ValidationRow> run_case(const ValidationCase& of, kernel::Isa isa,
                                    const std::function<void(long)>& progress);

long runs_of(const ValidationCase& of);

}  // namespace carom::tools
