# For wheels of the Python package, which run on other machines: links libraries statically if possible. fmt
# and toml++ are used as headers, libpng and zlib as static libraries. Box2D and libpng are static if their
# packages allow it; those of Debian 12 do not, so auditwheel copies them into the wheel.
set(CMAKE_FIND_LIBRARY_SUFFIXES .a ${CMAKE_FIND_LIBRARY_SUFFIXES})
set(carom_fmt fmt::fmt-header-only)
# A static libpng must be position-independent, which that of Debian 12 is not.
include(CheckCXXSourceCompiles)
find_library(carom_png_archive libpng16.a)
if(carom_png_archive)
  set(CMAKE_REQUIRED_FLAGS "-shared -fPIC")
  set(CMAKE_REQUIRED_LIBRARIES ${carom_png_archive} z m)
  check_cxx_source_compiles(
    "#include <png.h>\nvoid* f() { return png_create_write_struct(nullptr, nullptr, nullptr, nullptr); }"
    carom_png_archive_links)
  unset(CMAKE_REQUIRED_FLAGS)
  unset(CMAKE_REQUIRED_LIBRARIES)
endif()
if(NOT carom_png_archive_links)
  find_library(PNG_LIBRARY_RELEASE NAMES libpng16.so libpng.so)
endif()
find_path(carom_toml_include toml++/toml.h REQUIRED)
add_library(tomlplusplus::tomlplusplus INTERFACE IMPORTED GLOBAL)
set_target_properties(tomlplusplus::tomlplusplus PROPERTIES
  INTERFACE_INCLUDE_DIRECTORIES ${carom_toml_include} INTERFACE_COMPILE_DEFINITIONS TOML_HEADER_ONLY=1)
