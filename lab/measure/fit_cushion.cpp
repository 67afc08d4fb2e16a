// Fits the carom cushion to the numbers of validation cases, for lab/notes/2026-11-presets.md: Nelder and
// Mead over e, c of e_c_fit = [e, c, 0] and a, b, k of f_c_fit = [a, b, k], with Cauchy's loss, which no
// outlier dominates. Prints the values, and for each case, including those not fitted, the count of numbers
// within their uncertainty.
//   cmake --build --preset release --target carom_fit_cushion
//   build/release/lab/measure/carom_fit_cushion V3,V4,V5
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "base/setup.h"
#include "validate/case.h"
#include "validate/run.h"

namespace {

using namespace carom::tools;
using Point = std::array<double, 5>;

struct Score {
    double loss = 0.0;
    int within = 0, all = 0;
};

Score score_of(ValidationCase of, const Point& p) {
    std::size_t numbers = 0;
    for (const ValidationShot& shot : of.shots) numbers += shot.measured.size();
    const std::string keys =
        fmt::format("e_c_fit = [{}, {}, 0]\nf_c_fit = [{}, {}, {}]", p[0], p[1], p[2], p[3], p[4]);
    of.variants = {Variant{"fit", "carom", keys, "", false, std::vector<Claim>(numbers)}};
    Score score;
    for (const ValidationRow& row : run_case(of, chosen_isa(), [](long) {})) {
        score.loss += std::log1p(row.deviation() * row.deviation());
        score.within += row.within() ? 1 : 0;
        ++score.all;
    }
    return score;
}

double loss_of(const std::vector<ValidationCase>& cases, const Point& p) {
    if (*std::min_element(p.begin(), p.end()) < 0.0 || p[0] > 1.0) return 1e9;
    double sum = 0.0;
    for (const ValidationCase& of : cases) sum += score_of(of, p).loss;
    return sum;
}

Point mix(const Point& a, const Point& b, double t) {
    Point p;
    for (std::size_t k = 0; k < p.size(); ++k) p[k] = a[k] + t * (b[k] - a[k]);
    return p;
}

Point least(const std::vector<ValidationCase>& cases, const Point& start) {
    struct Corner {
        Point p;
        double loss;
    };
    const auto corner = [&](const Point& p) { return Corner{p, loss_of(cases, p)}; };
    std::vector<Corner> s = {corner(start)};
    for (std::size_t k = 0; k < start.size(); ++k) {
        Point p = start;
        p[k] *= k == 0 ? 0.95 : 1.3;
        s.push_back(corner(p));
    }
    for (int round = 0; round < 400; ++round) {
        std::sort(s.begin(), s.end(), [](const Corner& a, const Corner& b) { return a.loss < b.loss; });
        Point centre{};
        for (std::size_t i = 0; i + 1 < s.size(); ++i)
            for (std::size_t k = 0; k < centre.size(); ++k)
                centre[k] += s[i].p[k] / static_cast<double>(s.size() - 1);
        Corner& worst = s.back();
        Corner next = corner(mix(centre, worst.p, -1.0));
        if (next.loss < s.front().loss) {
            const Corner farther = corner(mix(centre, worst.p, -2.0));
            if (farther.loss < next.loss) next = farther;
        } else if (next.loss >= s[s.size() - 2].loss) {
            next = corner(mix(centre, worst.p, 0.5));
        }
        if (next.loss < worst.loss)
            worst = next;
        else
            for (std::size_t i = 1; i < s.size(); ++i) s[i] = corner(mix(s[0].p, s[i].p, 0.5));
    }
    return std::min_element(s.begin(), s.end(),
                            [](const Corner& a, const Corner& b) { return a.loss < b.loss; })
        ->p;
}

}  // namespace

int main(int argc, char** argv) {
    std::vector<ValidationCase> all, fitted;
    const std::string wanted = fmt::format(",{},", argc > 1 ? argv[1] : "");
    for (const ValidationCase& of : chosen_cases("")) {
        if (of.about != About::kCushion || of.id == "V2") continue;
        all.push_back(of);
        if (wanted.find(fmt::format(",{},", of.id)) != std::string::npos) fitted.push_back(of);
    }
    Point p = {0.9, 0.02, 0.19, 0.23, 0.7};
    // Restart, in case the simplex shrank too early.
    for (int again = 0; again < 3 && !fitted.empty(); ++again) p = least(fitted, p);
    fmt::print("e_c_fit = [{:.3f}, {:.4f}, 0], f_c_fit = [{:.3f}, {:.3f}, {:.2f}], loss {:.2f}\n", p[0], p[1],
               p[2], p[3], p[4], loss_of(all, p));
    Score sum;
    for (const ValidationCase& of : all) {
        const Score score = score_of(of, p);
        fmt::print("{} {} of {}, ", of.id, score.within, score.all);
        sum.within += score.within;
        sum.all += score.all;
    }
    fmt::print("all {} of {}\n", sum.within, sum.all);
}
