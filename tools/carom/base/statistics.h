// Shares of shots and how sure they are.
#pragma once

#include <cstddef>
#include <string>

namespace carom::tools {

/// The interval of a share in which 95 of 100 such intervals hold the true one (Wilson, 1927).
struct Share {
    double value, low, high;
};
Share share_of(std::size_t part, std::size_t whole);
std::string share_text(const Share& share);

}  // namespace carom::tools
