#include <dlfcn.h>

#include "carom/render/backend.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "carom/render/error.h"
#include "gl/context.h"
#include "gl/shared_library.h"

namespace carom::render {

Backend default_backend() {
    static const Backend found = gl::has_osmesa() ? Backend::kOsmesa : Backend::kEgl;
    return found;
}

Backend backend_from_name(std::string_view text) {
    for (const Backend backend : {Backend::kAuto, Backend::kOsmesa, Backend::kEgl})
        if (text == name(backend)) return backend;
    throw RenderError("unknown OpenGL back end '" + std::string(text) + "'; use auto, osmesa or egl");
}

const char* name(Backend backend) {
    if (backend == Backend::kAuto) return "auto";
    return backend == Backend::kOsmesa ? "osmesa" : "egl";
}

std::unique_ptr<gl::Context> gl::make_context(Backend backend) {
    if (backend == Backend::kAuto) backend = default_backend();
    return backend == Backend::kOsmesa ? make_osmesa_context() : make_egl_context();
}

SharedLibrary::SharedLibrary(std::initializer_list<const char*> names, std::string package)
    : package_(std::move(package)) {
    std::string reason;
    for (const char* name : names) {
        library_ = dlopen(name, RTLD_NOW | RTLD_LOCAL);
        if (library_ != nullptr) return;
        if (reason.empty()) reason = dlerror();
    }
    throw RenderError(std::string("cannot load ") + *names.begin() + " (" + reason +
                      "); install the Debian package " + package_);
}

SharedLibrary::Function SharedLibrary::operator[](const char* symbol) const {
    if (void* address = dlsym(library_, symbol)) return {address};
    throw RenderError("the library of the Debian package " + package_ + " lacks " + symbol);
}

// EGL without a surface or display server. It replaces OSMesa, which Mesa 25.1 removed.
//
// The few types and constants of EGL 1.5 that are needed
// are declared here, so that the build needs no EGL header.

namespace gl {
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

// OSMesa: Mesa's software renderer that draws into memory.
//
// The few types and constants that are needed are declared here, so that the build needs no OSMesa header:
// Mesa 25.1 removed OSMesa, but the library of an older Mesa still works.

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

}  // namespace gl

}  // namespace carom::render
