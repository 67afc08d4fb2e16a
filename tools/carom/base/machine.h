// The lines of a benchmark about its machine.
#pragma once

#include <fstream>
#include <string>

namespace carom::tools {

/// Name of the processor, or "unknown".
inline std::string processor() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
    return "unknown";
}

}  // namespace carom::tools
