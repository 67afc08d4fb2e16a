# For what is carried to other machines (wheels of the Python package): libraries are linked into it where they can be. fmt and
# toml++ are their headers then, libpng and zlib their static libraries. Box2D is static where its package says so; Debian's is
# not, and auditwheel puts it into the wheel.
set(CMAKE_FIND_LIBRARY_SUFFIXES .a ${CMAKE_FIND_LIBRARY_SUFFIXES})
set(carom_fmt fmt::fmt-header-only)
find_path(carom_toml_include toml++/toml.h REQUIRED)
add_library(tomlplusplus::tomlplusplus INTERFACE IMPORTED GLOBAL)
set_target_properties(tomlplusplus::tomlplusplus PROPERTIES
  INTERFACE_INCLUDE_DIRECTORIES ${carom_toml_include} INTERFACE_COMPILE_DEFINITIONS TOML_HEADER_ONLY=1)
