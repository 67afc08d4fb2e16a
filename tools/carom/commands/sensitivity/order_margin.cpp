#include "order_margin.h"

#include <fmt/format.h>

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "base/setup.h"
#include "carom/engine/scene_number.h"
#include "carom/engine/simulate.h"

namespace carom::tools {
namespace {

constexpr int kDoublings = 20, kBisections = 24;

std::vector<const Event*> events_of(const Record& record, int ball) {
    std::vector<const Event*> list;
    for (const Event& event : record.events)
        if (event.a == ball || (kind(event.type).partner == Partner::kBall && event.b == ball))
            list.push_back(&event);
    return list;
}

/// The first event of a ball that only one of the two shots has; "" if they have the same events.
std::string first_change(const Record& meant, const Record& other) {
    const auto same = [](const Event& p, const Event& q) {
        return p.type == q.type && p.a == q.a && p.b == q.b;
    };
    double first = std::numeric_limits<double>::infinity();
    std::string what;
    for (int ball = 0; ball < static_cast<int>(meant.tracks.size()); ++ball) {
        const auto one = events_of(meant, ball), two = events_of(other, ball);
        std::size_t k = 0;
        while (k < one.size() && k < two.size() && same(*one[k], *two[k])) ++k;
        if (k == one.size() && k == two.size()) continue;
        const bool is_new = k == one.size() || (k < two.size() && two[k]->time < one[k]->time);
        const Record& record = is_new ? other : meant;
        const Event& event = is_new ? *two[k] : *one[k];
        if (!(event.time < first)) continue;
        first = event.time;
        const std::string partner = record.partner_id(event);
        what = fmt::format("the {} of {}{}{} at {:.3f} s is {}", name(event.type),
                           record.tracks[static_cast<std::size_t>(event.a)].id,
                           partner.empty() ? "" : " and ", partner, event.time, is_new ? "new" : "missing");
    }
    return what;
}

}  // namespace

OrderMargin order_margin(const Plan& plan, const Record& record, const std::string& input, double first) {
    const SceneNumber number(plan.scene, input);
    const double value = number.value(plan.scene);
    const auto change_at = [&](double by) -> std::string {
        Scene scene = plan.scene;
        try {
            number.put(scene, value + by);
            validate(scene);
            return first_change(record, simulate(make_plan(scene, plan.isa), interruptible()));
        } catch (const SceneError& error) {
            return error.message();
        } catch (const SimulationError&) {
            return "the simulation fails";
        }
    };
    const auto bound = [&](double way) -> std::pair<double, std::string> {
        double inside = 0.0, outside = first;
        std::string why = change_at(way * outside);
        for (int k = 0; k < kDoublings && why.empty(); ++k) {
            inside = outside;
            outside *= 2.0;
            why = change_at(way * outside);
        }
        if (why.empty()) return {std::numeric_limits<double>::infinity(), ""};
        for (int k = 0; k < kBisections; ++k) {
            const double middle = 0.5 * (inside + outside);
            const std::string here = change_at(way * middle);
            (here.empty() ? inside : outside) = middle;
            if (!here.empty()) why = here;
        }
        return {inside, why};
    };
    const auto [down, down_why] = bound(-1.0);
    const auto [up, up_why] = bound(1.0);
    return {down, up, down_why, up_why};
}

}  // namespace carom::tools
