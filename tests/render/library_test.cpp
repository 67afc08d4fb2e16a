// Messages on a machine without the libraries.
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "carom/render/backend.h"
#include "carom/render/error.h"
#include "gl/context.h"
#include "gl/shared_library.h"

namespace carom::render {
namespace {

TEST(SharedLibrary, AMissingOneNamesItsPackage) {
    try {
        const SharedLibrary missing({"libCaromIsNotThere.so.8", "libCaromIsNotThere.so"}, "libosmesa6");
        FAIL();
    } catch (const RenderError& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("libCaromIsNotThere.so.8"), std::string::npos) << message;
        EXPECT_NE(message.find("install the Debian package libosmesa6"), std::string::npos) << message;
    }
}

TEST(SharedLibrary, AMissingFunctionIsNamed) {
    const SharedLibrary library({"libc.so.6"}, "libc6");
    int (*absolute)(int) = library["abs"];
    EXPECT_EQ(absolute(-3), 3);
    try {
        static_cast<void>(library["carom_is_not_there"]);
        FAIL();
    } catch (const RenderError& error) {
        EXPECT_NE(std::string(error.what()).find("carom_is_not_there"), std::string::npos) << error.what();
    }
}

TEST(Backends, NamesAreReadAndUnknownOnesRefused) {
    for (const char* known : {"auto", "osmesa", "egl"}) EXPECT_STREQ(name(backend_from_name(known)), known);
    EXPECT_THROW(backend_from_name("glx"), RenderError);
    EXPECT_EQ(default_backend(), gl::has_osmesa() ? Backend::kOsmesa : Backend::kEgl);
}

TEST(Backends, AContextFindsTheFunctionsOfOpenGl) {
    const std::unique_ptr<gl::Context> context = gl::make_context(Backend::kAuto);
    context->make_current();
    EXPECT_NE(context->lookup()("glDrawArraysInstanced"), nullptr);
}

}  // namespace
}  // namespace carom::render
