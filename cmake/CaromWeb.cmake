# For the preset wasm: the libraries that carom needs, for WebAssembly. All are headers of this machine,
# except Box2D, of which carom uses the tree of boxes; its two sources are compiled here. tools/web fetches
# them.
#
# find_package() finds these targets by the files in CMAKE_FIND_PACKAGE_REDIRECTS_DIR, so that the libraries'
# own CMake files need not know about WebAssembly.
set(CAROM_HOST_HEADERS /usr/include CACHE PATH "Where CLI11, Eigen, fmt, nlohmann/json and toml++ are")
set(CAROM_BOX2D_SOURCES "${PROJECT_BINARY_DIR}/box2d" CACHE PATH "The sources of Box2D 2.4.1")
if(NOT EXISTS ${CAROM_BOX2D_SOURCES}/src/collision/b2_dynamic_tree.cpp)
  message(FATAL_ERROR "${CAROM_BOX2D_SOURCES} lacks the sources of Box2D 2.4.1; run tools/web, which fetches "
    "them, or set CAROM_BOX2D_SOURCES")
endif()

# Links, because the folder itself also has the C library's headers, which are not for WebAssembly.
set(headers ${PROJECT_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${headers})
foreach(pair CLI=CLI Eigen=eigen3/Eigen fmt=fmt nlohmann=nlohmann toml++=toml++)
  string(REPLACE "=" ";" pair ${pair})
  list(GET pair 0 name)
  list(GET pair 1 from)
  if(NOT EXISTS ${CAROM_HOST_HEADERS}/${from})
    message(FATAL_ERROR "${CAROM_HOST_HEADERS}/${from} is missing; install it, or set CAROM_HOST_HEADERS")
  endif()
  file(CREATE_LINK ${CAROM_HOST_HEADERS}/${from} ${headers}/${name} SYMBOLIC)
endforeach()

foreach(target CLI11::CLI11 Eigen3::Eigen fmt::fmt-header-only nlohmann_json::nlohmann_json
    tomlplusplus::tomlplusplus)
  add_library(${target} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${target} SYSTEM INTERFACE ${headers})
endforeach()
target_compile_definitions(fmt::fmt-header-only INTERFACE FMT_HEADER_ONLY=1)
target_compile_definitions(tomlplusplus::tomlplusplus INTERFACE TOML_HEADER_ONLY=1)
set(carom_fmt fmt::fmt-header-only)

add_library(carom_box2d STATIC
  ${CAROM_BOX2D_SOURCES}/src/collision/b2_dynamic_tree.cpp ${CAROM_BOX2D_SOURCES}/src/common/b2_settings.cpp)
add_library(box2d::box2d ALIAS carom_box2d)
target_include_directories(carom_box2d SYSTEM PUBLIC ${CAROM_BOX2D_SOURCES}/include)
target_compile_options(carom_box2d PRIVATE -ffp-contract=off)

# Of zlib, the pictures in glTF files need the checksum alone.
add_library(ZLIB::ZLIB INTERFACE IMPORTED GLOBAL)
target_include_directories(ZLIB::ZLIB INTERFACE ${PROJECT_SOURCE_DIR}/web/src/zlib)

foreach(package cli11 eigen3 fmt nlohmann_json tomlplusplus box2d)
  file(WRITE ${CMAKE_FIND_PACKAGE_REDIRECTS_DIR}/${package}-config.cmake "")
  file(WRITE ${CMAKE_FIND_PACKAGE_REDIRECTS_DIR}/${package}-config-version.cmake
    "set(PACKAGE_VERSION_COMPATIBLE TRUE)\n")
endforeach()

# Where clang 14 of emscripten 3.1.6 makes vectors of scalar code by itself, impacts of unlike balls get other
# bits: 6 of 2000 variations did. Vectors that the source asks for are not affected.
target_compile_options(carom_flags INTERFACE -fno-slp-vectorize)
# Fills gaps in the C++ library of older emscripten versions.
target_compile_options(carom_flags INTERFACE "SHELL:-include ${PROJECT_SOURCE_DIR}/web/src/compat.h")
