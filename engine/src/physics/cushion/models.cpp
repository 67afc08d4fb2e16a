// The list of cushion models, each in its own file of this folder, and their shared laws of friction and
// restitution.
#include "carom/engine/cushion.h"

#include <algorithm>
#include <span>
#include <string_view>

#include "carom/engine/math.h"
#include "carom/engine/scene.h"
#include "physics/cushion/nose.h"

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

CushionContact cushion_contact(const BallParams& balls, const BallSize& size, double height,
                               const Vec2& normal, const Vec3& v, const Vec3& w) {
    CushionContact contact{
        .R = size.R, .m = size.m, .mu_s = balls.mu_s, .e_c = balls.e_c, .f_c = balls.f_c, .height = height};
    if (!balls.cushion_friction().constant())
        contact.f_c = balls.cushion_friction()(detail::nose_contact(contact, normal, v, w).speed_t);
    if (balls.e_c_fall != 0.0) contact.e_c = cushion_restitution(balls, detail::approach_speed(normal, v));
    return contact;
}

double cushion_restitution(const BallParams& balls, double speed) {
    if (balls.e_c_fall == 0.0) return balls.e_c;
    return std::max(0.0, balls.e_c - balls.e_c_fall * std::max(0.0, speed - balls.e_c_above));
}

double coulomb_grip(double e, double f, double v_n, double slip) {
    return std::min(f * ((1.0 + e) * v_n), 2.0 / 7.0 * slip);
}

}  // namespace carom
