// Shared by the tests of the laboratory's command line.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tools/cli.h"

namespace carom::test {

inline ProcessResult carom_lab(std::vector<std::string> arguments, ProcessOptions options = {}) {
    return run_built(CAROM_LAB_PROGRAM, std::move(arguments), std::move(options));
}

inline ProcessResult carom_lab_isa(const std::string& isa, const std::vector<std::string>& arguments) {
    ProcessOptions options;
    options.environment = {{"CAROM_ISA", isa}};
    return carom_lab(arguments, options);
}

}  // namespace carom::test
