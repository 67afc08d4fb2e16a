// Numbers with a unit as text: "57.15 mm", "9 ft", "20 mph".
#pragma once

#include <string>
#include <string_view>

namespace carom::detail {

/// The number in the unit `wanted` of a key ("m", "m/s", "kg", "s", "degrees"). Units that differ by a power
/// of ten give the same bits as the number written out: "57.15 mm" is 0.05715.
/// @throws std::invalid_argument with the fault and the available units, to follow the key's name
double number_with_unit(std::string_view text, std::string_view wanted);

}  // namespace carom::detail
