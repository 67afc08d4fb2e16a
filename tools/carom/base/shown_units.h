// Units in printed text. Files are always in SI.
#pragma once

#include <fmt/format.h>

#include <string>

namespace carom::tools {

enum class Units { kMetric, kInch };

/// The choices of --units, in the order of the enumeration.
inline constexpr const char* kUnits[] = {"metric", "inch"};

/// @throws std::out_of_range never: options.cpp has checked the name
inline Units units_of(const std::string& name) {
    return name == kUnits[1] ? Units::kInch : Units::kMetric;
}

/// A factor and its name: 2.1 m/s or 4.7 mph, 0.635000 m or 25.0000 in.
struct Unit {
    double factor;
    const char* name;
};
inline Unit speed_unit(Units units) {
    return units == Units::kInch ? Unit{3600.0 / 1609.344, "mph"} : Unit{1.0, "m/s"};
}
inline Unit length_unit(Units units) {
    return units == Units::kInch ? Unit{1.0 / 0.0254, "in"} : Unit{1.0, "m"};
}
inline std::string speed_text(double speed, Units units) {
    const Unit unit = speed_unit(units);
    return fmt::format("{:.1f} {}", speed * unit.factor, unit.name);
}

}  // namespace carom::tools
