// How --help shows an option: alike with every release of CLI11, whose own form differs (2.1: "S=0", 2.4: "S [0]").
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace carom::tools {

class HelpFormatter : public CLI::Formatter {
  public:
    /// What stands behind the name: type and choices, default, how often it may come, what it goes with.
    std::string make_option_opts(const CLI::Option* option) const override {
        if (option->get_type_size() == 0) return "";
        std::string text;
        if (!option->get_type_name().empty()) text += " " + option->get_type_name();
        if (!option->get_default_str().empty()) text += "=" + option->get_default_str();
        if (option->get_expected_max() == CLI::detail::expected_max_vector_size) text += " ...";
        if (option->get_required()) text += " REQUIRED";
        for (const CLI::Option* other : option->get_needs()) text += " Needs: " + other->get_name();
        for (const CLI::Option* other : option->get_excludes()) text += " Excludes: " + other->get_name();
        return text;
    }
};

}  // namespace carom::tools
