// OSMesa: Mesa's software renderer that draws into memory.
//
// The few types and constants that are needed are declared here, so that the build needs no OSMesa header:
// Mesa 25.1 removed OSMesa, but the library of an older Mesa still works.
#include <array>
#include <cstdint>
#include <memory>

#include "carom/render/error.h"
#include "gl/context.h"
#include "gl/shared_library.h"

namespace carom::render::gl {
namespace {

using Handle = void*;                       // OSMesaContext
constexpr int kFormat = 0x22;               // OSMESA_FORMAT
constexpr int kRgba = 0x1908;               // OSMESA_RGBA
constexpr int kProfile = 0x33;              // OSMESA_PROFILE
constexpr int kOsmesaCoreProfile = 0x34;    // OSMESA_CORE_PROFILE
constexpr int kOsmesaContextMajor = 0x36;   // OSMESA_CONTEXT_MAJOR_VERSION
constexpr int kOsmesaContextMinor = 0x37;   // OSMESA_CONTEXT_MINOR_VERSION
constexpr int kDepthBits = 0x30;            // OSMESA_DEPTH_BITS
constexpr unsigned kUnsignedByte = 0x1401;  // GL_UNSIGNED_BYTE

struct OsmesaLibrary {
    SharedLibrary library{{"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"}, "libosmesa6"};
    Handle (*create)(const int*, Handle) = library["OSMesaCreateContextAttribs"];
    void (*destroy)(Handle) = library["OSMesaDestroyContext"];
    unsigned char (*make_current)(Handle, void*, unsigned, int, int) = library["OSMesaMakeCurrent"];
    Lookup get_proc_address = library["OSMesaGetProcAddress"];
};

const OsmesaLibrary& osmesa() {
    static const OsmesaLibrary library;
    return library;
}

class OsmesaContext final : public Context {
  public:
    OsmesaContext() : Context(osmesa().get_proc_address) {
        const std::array<int, 11> attributes{
            kFormat,    kRgba, kProfile, kOsmesaCoreProfile, kOsmesaContextMajor, 3, kOsmesaContextMinor, 3,
            kDepthBits, 0,     0};
        context_ = osmesa().create(attributes.data(), nullptr);
        if (context_ == nullptr)
            throw RenderError("OSMesa cannot create an OpenGL 3.3 core context; use --gl egl");
    }
    ~OsmesaContext() override { osmesa().destroy(context_); }

    void make_current() override {
        if (!osmesa().make_current(context_, pixels_.data(), kUnsignedByte, kSide, kSide)) {
            throw RenderError("OSMesaMakeCurrent failed; use --gl egl");
        }
    }

  private:
    // [pixels] Side of the default framebuffer. It is never used:
    // all drawing goes to framebuffer objects, as with EGL.
    static constexpr int kSide = 16;
    std::array<std::uint8_t, std::size_t{kSide} * kSide * 4> pixels_{};
    Handle context_ = nullptr;
};

}  // namespace

bool has_osmesa() {
    try {
        osmesa();
        return true;
    } catch (const RenderError&) {
        return false;
    }
}

std::unique_ptr<Context> make_osmesa_context() {
    return std::make_unique<OsmesaContext>();
}

}  // namespace carom::render::gl
