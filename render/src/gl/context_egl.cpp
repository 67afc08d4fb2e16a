// EGL without a surface or display server. It replaces OSMesa, which Mesa 25.1 removed.
//
// The few types and constants of EGL 1.5 that are needed
// are declared here, so that the build needs no EGL header.
#include <array>
#include <cstdint>
#include <memory>

#include "carom/render/error.h"
#include "gl/context.h"
#include "gl/shared_library.h"

namespace carom::render::gl {
namespace {

using Handle = void*;  // EGLDisplay, EGLContext, EGLSurface, EGLConfig
using EglInt = std::int32_t;
constexpr unsigned kPlatformSurfaceless = 0x31DD;  // EGL_PLATFORM_SURFACELESS_MESA
constexpr unsigned kOpenGlApi = 0x30A2;            // EGL_OPENGL_API
constexpr EglInt kContextMajor = 0x3098;           // EGL_CONTEXT_MAJOR_VERSION
constexpr EglInt kContextMinor = 0x30FB;           // EGL_CONTEXT_MINOR_VERSION
constexpr EglInt kProfileMask = 0x30FD;            // EGL_CONTEXT_OPENGL_PROFILE_MASK
constexpr EglInt kCoreProfile = 0x1;               // EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT
constexpr EglInt kNone = 0x3038;                   // EGL_NONE

struct EglLibrary {
    SharedLibrary library{{"libEGL.so.1", "libEGL.so"}, "libegl1 (with libegl-mesa0)"};
    Handle (*get_platform_display)(unsigned, void*, const std::intptr_t*) = library["eglGetPlatformDisplay"];
    unsigned (*initialize)(Handle, EglInt*, EglInt*) = library["eglInitialize"];
    unsigned (*bind_api)(unsigned) = library["eglBindAPI"];
    Handle (*create_context)(Handle, Handle, Handle, const EglInt*) = library["eglCreateContext"];
    unsigned (*destroy_context)(Handle, Handle) = library["eglDestroyContext"];
    unsigned (*make_current)(Handle, Handle, Handle, Handle) = library["eglMakeCurrent"];
    Lookup get_proc_address = library["eglGetProcAddress"];
};

const EglLibrary& egl() {
    static const EglLibrary library;
    return library;
}

// The process has one display, which all contexts share and which is never terminated.
Handle display() {
    static const Handle shared = [] {
        Handle opened = egl().get_platform_display(kPlatformSurfaceless, nullptr, nullptr);
        if (opened == nullptr || egl().initialize(opened, nullptr, nullptr) == 0) {
            throw RenderError(
                "EGL has no surfaceless platform; install the Debian packages libegl-mesa0 and "
                "libgl1-mesa-dri, or use --gl osmesa");
        }
        return opened;
    }();
    return shared;
}

class EglContext final : public Context {
  public:
    EglContext() : Context(egl().get_proc_address) {
        Handle shared = display();
        egl().bind_api(kOpenGlApi);
        const std::array<EglInt, 7> attributes{kContextMajor, 3,    kContextMinor, 3, kProfileMask,
                                               kCoreProfile,  kNone};
        context_ = egl().create_context(shared, nullptr, nullptr, attributes.data());
        if (context_ == nullptr) {
            throw RenderError(
                "EGL cannot create an OpenGL 3.3 core context; install the Debian package libgl1-mesa-dri, "
                "or use --gl osmesa");
        }
    }
    ~EglContext() override { egl().destroy_context(display(), context_); }

    void make_current() override {
        if (egl().make_current(display(), nullptr, nullptr, context_) == 0) {
            throw RenderError("eglMakeCurrent without a surface failed; use --gl osmesa");
        }
    }

  private:
    Handle context_ = nullptr;
};

}  // namespace

std::unique_ptr<Context> make_egl_context() {
    return std::make_unique<EglContext>();
}

}  // namespace carom::render::gl
