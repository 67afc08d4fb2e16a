// OSMesa: Mesa's software renderer into memory. Only its header is needed to build; it pulls in <GL/gl.h>,
// whose names collide with those of <GL/glcorearb.h>, so that nothing of it leaves this file.
#include <GL/osmesa.h>

#include <array>
#include <cstdint>

#include "carom/render/error.h"
#include "gl_context.h"
#include "shared_library.h"

namespace carom::render::gl {
namespace {

constexpr const char* kPackage = "libosmesa6";

struct OsmesaLibrary {
    decltype(&OSMesaCreateContextAttribs) create;
    decltype(&OSMesaDestroyContext) destroy;
    decltype(&OSMesaMakeCurrent) make_current;
    decltype(&OSMesaGetProcAddress) get_proc_address;
};

const OsmesaLibrary& osmesa() {
    static const OsmesaLibrary library = [] {
        const std::array<const char*, 3> names{"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"};
        void* handle = open_library(names.data(), static_cast<int>(names.size()), kPackage);
        OsmesaLibrary found{};
        const auto find = [handle](auto& function, const char* symbol) {
            function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(
                find_symbol(handle, symbol, kPackage));
        };
        find(found.create, "OSMesaCreateContextAttribs");
        find(found.destroy, "OSMesaDestroyContext");
        find(found.make_current, "OSMesaMakeCurrent");
        find(found.get_proc_address, "OSMesaGetProcAddress");
        return found;
    }();
    return library;
}

void* lookup_osmesa(const char* function) {
    return reinterpret_cast<void*>(osmesa().get_proc_address(function));
}

class OsmesaContext final : public Context {
  public:
    OsmesaContext() {
        const std::array<int, 11> attributes{OSMESA_FORMAT,
                                             OSMESA_RGBA,
                                             OSMESA_PROFILE,
                                             OSMESA_CORE_PROFILE,
                                             OSMESA_CONTEXT_MAJOR_VERSION,
                                             3,
                                             OSMESA_CONTEXT_MINOR_VERSION,
                                             3,
                                             OSMESA_DEPTH_BITS,
                                             0,
                                             0};
        context_ = osmesa().create(attributes.data(), nullptr);
        if (context_ == nullptr) throw RenderError("OSMesa gives no OpenGL 3.3 core context; use --gl egl");
    }
    ~OsmesaContext() override { osmesa().destroy(context_); }

    void make_current() override {
        if (!osmesa().make_current(context_, pixels_.data(), GL_UNSIGNED_BYTE, kSide, kSide)) {
            throw RenderError("OSMesaMakeCurrent failed; use --gl egl");
        }
    }
    void release() override { osmesa().make_current(nullptr, nullptr, 0, 0, 0); }
    Lookup lookup() const override { return &lookup_osmesa; }

  private:
    // The default framebuffer is never drawn to: all drawing goes to framebuffer objects, as with EGL.
    static constexpr int kSide = 16;
    std::array<std::uint8_t, std::size_t{kSide} * kSide * 4> pixels_{};
    OSMesaContext context_ = nullptr;
};

}  // namespace

std::unique_ptr<Context> make_osmesa_context() {
    return std::make_unique<OsmesaContext>();
}

}  // namespace carom::render::gl
