// What a machine without the libraries is told.
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string>

#include "carom/render/backend.h"
#include "carom/render/error.h"
#include "gl/context.h"
#include "gl/shared_library.h"

namespace carom::render {
namespace {

TEST(SharedLibrary, AMissingOneNamesItsPackage) {
    const std::array<const char*, 2> names{"libCaromIsNotThere.so.8", "libCaromIsNotThere.so"};
    try {
        open_library(names.data(), 2, "libosmesa6");
        FAIL();
    } catch (const RenderError& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("libCaromIsNotThere.so.8"), std::string::npos) << message;
        EXPECT_NE(message.find("install the Debian package libosmesa6"), std::string::npos) << message;
    }
}

TEST(SharedLibrary, AMissingFunctionIsNamed) {
    const std::array<const char*, 1> names{"libc.so.6"};
    void* library = open_library(names.data(), 1, "libc6");
    EXPECT_NE(find_symbol(library, "malloc", "libc6"), nullptr);
    try {
        find_symbol(library, "carom_is_not_there", "libc6");
        FAIL();
    } catch (const RenderError& error) {
        EXPECT_NE(std::string(error.what()).find("carom_is_not_there"), std::string::npos) << error.what();
    }
}

TEST(Backends, NamesAreReadAndUnknownOnesRefused) {
    EXPECT_EQ(backend_from_name("osmesa"), Backend::kOsmesa);
    EXPECT_EQ(backend_from_name("egl"), Backend::kEgl);
    EXPECT_THROW(backend_from_name("glx"), RenderError);
    EXPECT_STREQ(name(Backend::kOsmesa), "osmesa");
    EXPECT_STREQ(name(Backend::kEgl), "egl");
}

TEST(Backends, AContextKnowsTheFunctionsOfOpenGl) {
    const std::unique_ptr<gl::Context> context = gl::make_context(Backend::kOsmesa);
    context->make_current();
    EXPECT_NE(context->lookup()("glDrawArraysInstanced"), nullptr);
}

}  // namespace
}  // namespace carom::render
