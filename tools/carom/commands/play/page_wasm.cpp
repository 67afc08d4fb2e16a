#include <string>

#include "base/console.h"
#include "commands/play/play_files.h"

namespace carom::tools {

std::string page_wasm() {
    std::string wasm = play_file("carom.wasm.gz.b64");
    if (wasm.empty())
        throw UsageError("this carom was built without WebAssembly; run tools/web, then build carom again");
    return wasm;
}

}  // namespace carom::tools
