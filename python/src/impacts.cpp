// Single impacts, many at once.
#include <nanobind/stl/string.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "carom/carom.h"
#include "carom/engine/ball_ball.h"
#include "carom/engine/cushion.h"
#include "native.h"

namespace carom::python {
namespace {

/// Numbers of a state, and of a row of parameters.
constexpr std::size_t kState = 9, kParams = 6;

std::string numbered(std::size_t i, const std::string& why) {
    return "impact " + std::to_string(i) + ": " + why;
}

/// The model of this name. @throws nb::value_error listing the known ones
template <class Model>
const Model& model_named(const char* kind, const std::string& name) {
    std::string known;
    for (const Model* model : all_of(static_cast<const Model*>(nullptr))) {
        if (name == model->name) return *model;
        known += (known.empty() ? "" : ", ") + std::string(model->name);
    }
    throw nb::value_error(
        ("no " + std::string(kind) + " model \"" + name + "\"; expected one of " + known).c_str());
}

kernel::Ball ball_of(const double* rvw) {
    kernel::Ball ball{};
    std::copy_n(rvw, 3, ball.r);
    std::copy_n(rvw + 3, 3, ball.v);
    std::copy_n(rvw + 6, 3, ball.w);
    return ball;
}

void put(const double* in, const double (&v)[3], const double (&w)[3], double* out) {
    std::copy_n(in, 3, out);
    std::copy_n(v, 3, out + 3);
    std::copy_n(w, 3, out + 6);
}

/// The closed forms. @return the error of the first bad impact, or ""
std::string by_formula(const BallBallModelInfo& model, std::size_t count, const double* in1,
                       const double* in2, const double* params, std::size_t stride, double* out1,
                       double* out2) {
    std::string wrong;
    for (std::size_t i = 0; i < count; ++i) {
        const double* p = params + i * stride;
        kernel::ImpactResult result{};
        model.collide({}, ball_of(in1 + kState * i), ball_of(in2 + kState * i),
                      {p[0], p[1], p[2], p[3], p[4], p[5]}, result);
        put(in1 + kState * i, result.v1, result.w1, out1 + kState * i);
        put(in2 + kState * i, result.v2, result.w2, out2 + kState * i);
        const std::string why = kernel::describe(result.status);
        if (!why.empty() && wrong.empty()) wrong = numbered(i, why);
    }
    return wrong;
}

/// params: radius, mass, mu_s of both, mu_b, e_b; one row for all impacts, or one for each.
void ball_ball(const std::string& name, double tolerance, const Flat<const double>& in1,
               const Flat<const double>& in2, const Flat<const double>& params, const Flat<double>& out1,
               const Flat<double>& out2) {
    const BallBallModelInfo& model = model_named<BallBallModelInfo>("ball-ball", name);
    const std::size_t count = in1.size() / kState, rows = params.size() / kParams;
    std::string wrong;
    {
        const nb::gil_scoped_release no_gil;
        static_assert(sizeof(carom_impact_params) == kParams * sizeof(double));
        if (!model.reads_tolerance)
            wrong = by_formula(model, count, in1.data(), in2.data(), params.data(), rows == 1 ? 0 : kParams,
                               out1.data(), out2.data());
        else if (carom_collide_balls_batch(count, in1.data(), in2.data(),
                                           reinterpret_cast<const carom_impact_params*>(params.data()), rows,
                                           tolerance, out1.data(), out2.data(), nullptr) != CAROM_OK)
            wrong = carom_last_error();
    }
    if (!wrong.empty()) throw nb::value_error(wrong.c_str());
}

/// params: radius, mass, mu_s, e_c, f_c, height of the nose; normals: unit, from the cushion into the table.
/// Both have one row for all impacts, or one for each.
void ball_cushion(const std::string& name, const Flat<const double>& in, const Flat<const double>& normals,
                  const Flat<const double>& params, const Flat<double>& out) {
    const CushionModelInfo& model = model_named<CushionModelInfo>("cushion", name);
    const std::size_t count = in.size() / kState;
    const std::size_t normal_stride = normals.size() == 2 ? 0 : 2,
                      stride = params.size() == kParams ? 0 : kParams;
    std::string wrong;
    {
        const nb::gil_scoped_release no_gil;
        for (std::size_t i = 0; i < count && wrong.empty(); ++i) {
            const double *p = params.data() + i * stride, *n = normals.data() + i * normal_stride;
            const double* rvw = in.data() + kState * i;
            const CushionContact contact{p[0], p[1], p[2], p[3], p[4], p[5]};
            Vec3 v(rvw[3], rvw[4], rvw[5]), w(rvw[6], rvw[7], rvw[8]);
            if (model.accepts != nullptr && !model.accepts(contact))
                wrong = numbered(
                    i, "with this f_c and mu_s the ball could jam under the nose; lower one of them");
            else if (!model.resolve(contact, {n[0], n[1]}, v, w))
                wrong = numbered(i, "the model found no solution; lower the frictions");
            else if (!(v.allFinite() && w.allFinite()))
                wrong = numbered(i, "the result is too large");
            double* to = out.data() + kState * i;
            std::copy_n(rvw, 3, to);
            std::copy_n(v.data(), 3, to + 3);
            std::copy_n(w.data(), 3, to + 6);
        }
    }
    if (!wrong.empty()) throw nb::value_error(wrong.c_str());
}

}  // namespace

void add_impacts(nb::module_& m) {
    m.def("ball_ball", ball_ball, nb::arg("model"), nb::arg("tolerance"), nb::arg("in1"), nb::arg("in2"),
          nb::arg("params"), nb::arg("out1").noconvert(), nb::arg("out2").noconvert());
    m.def("ball_cushion", ball_cushion, nb::arg("model"), nb::arg("rvw"), nb::arg("normals"),
          nb::arg("params"), nb::arg("out").noconvert());
}

}  // namespace carom::python
