#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/output_file.h"
#include "carom/render/error.h"
#include "carom/render/png.h"

namespace carom::render {

void write_file(const std::string& path, const std::vector<std::uint8_t>& bytes) {
    try {
        OutputFile file(path);
        file.write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
        file.commit();
    } catch (const std::runtime_error& error) {
        throw RenderError(error.what());
    }
}

}  // namespace carom::render
