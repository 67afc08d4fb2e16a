# For wheels of the Python package, which run on other machines: links libraries statically if possible. fmt
# and toml++ are used as headers, libpng and zlib as static libraries. Box2D is static if its package is;
# Debian's is not, so auditwheel copies it into the wheel.
set(CMAKE_FIND_LIBRARY_SUFFIXES .a ${CMAKE_FIND_LIBRARY_SUFFIXES})
set(carom_fmt fmt::fmt-header-only)
find_path(carom_toml_include toml++/toml.h REQUIRED)
add_library(tomlplusplus::tomlplusplus INTERFACE IMPORTED GLOBAL)
set_target_properties(tomlplusplus::tomlplusplus PROPERTIES
  INTERFACE_INCLUDE_DIRECTORIES ${carom_toml_include} INTERFACE_COMPILE_DEFINITIONS TOML_HEADER_ONLY=1)
