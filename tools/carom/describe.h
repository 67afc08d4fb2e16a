// The program described for others to read: a man page, completions for bash and zsh. Made from the very
// options that are parsed, so that they cannot drift apart.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace carom::tools {

std::string man_page(const CLI::App& app, const std::string& version);
std::string bash_completion(const CLI::App& app);
std::string zsh_completion(const CLI::App& app);

}  // namespace carom::tools
