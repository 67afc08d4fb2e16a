# carom_flags: the compile options of every target of the project.
#
# -ffp-contract=off: a fused multiply-add happens only where the source says std::fma or an intrinsic, so that
# gcc and clang, debug and release, and every instruction set give the same bits (design: numbers).
add_library(carom_flags INTERFACE)
target_compile_features(carom_flags INTERFACE cxx_std_20)
target_compile_options(carom_flags INTERFACE
  -ffp-contract=off
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
  # A switch over an enumeration has no default: a new enumerator does not compile until each one handles it.
  -Werror=switch)
# At -O3, gcc 14.2 (Debian 13) removes stores that a function reads through a reference: a spotted ball then
# lay on another one. Versions 12 and 13 do not.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 14)
  target_compile_options(carom_flags INTERFACE -fno-ipa-modref)
endif()
# clang's libFuzzer is part of the address sanitizer, so the tests and the fuzz targets share one build.
set(carom_fuzz OFF)
if(CAROM_SANITIZE STREQUAL "address")
  set(carom_sanitizers address,undefined)
  # These checks cost a quarter of the compile time. The address sanitizer or the processor stops at most of
  # what they would find.
  set(carom_not_looked_for -fno-sanitize=null,alignment,object-size,pointer-overflow,vptr)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    set(carom_fuzz ON)
  endif()
elseif(CAROM_SANITIZE STREQUAL "thread")
  set(carom_sanitizers thread)
elseif(CAROM_SANITIZE)
  message(FATAL_ERROR "CAROM_SANITIZE=${CAROM_SANITIZE}: expected OFF, address or thread")
endif()
if(carom_sanitizers)
  # Tests themselves are checked for memory and threads only, the code under test also for undefined
  # behaviour. This saves a quarter of the tests' compile time.
  string(REPLACE ",undefined" "" carom_test_sanitizers ${carom_sanitizers})
  set(of_a_test $<BOOL:$<TARGET_PROPERTY:carom_is_a_test>>)
  target_compile_options(carom_flags INTERFACE
    $<$<NOT:${of_a_test}>:-fsanitize=${carom_sanitizers}> $<${of_a_test}:-fsanitize=${carom_test_sanitizers}>
    ${carom_not_looked_for} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(carom_flags INTERFACE -fsanitize=${carom_sanitizers})
  # For tests of what a sanitizer changes, mostly memory.
  target_compile_definitions(carom_flags INTERFACE CAROM_SANITIZED)
endif()

if(CAROM_HARDENED)
  # Older compilers and C libraries treat level 3 as 2. It needs an optimising compiler.
  target_compile_options(carom_flags INTERFACE
    $<$<NOT:$<CONFIG:Debug>>:-U_FORTIFY_SOURCE> $<$<NOT:$<CONFIG:Debug>>:-D_FORTIFY_SOURCE=3>
    -fstack-protector-strong)
  target_link_options(carom_flags INTERFACE LINKER:-z,relro,-z,now)
endif()

# Leaves out stack protectors in sources that read no input: in the loop they cost 2 to 4 % of its
# instructions.
function(carom_without_stack_protector)
  if(CAROM_HARDENED)
    set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_OPTIONS -fno-stack-protector)
  endif()
endfunction()

# Precompiles the headers that most sources of TARGET include. Sources of hardened builds have their own
# options, which a precompiled header would not match; emscripten cannot precompile one.
function(carom_precompile target)
  if(NOT CAROM_HARDENED AND NOT EMSCRIPTEN)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# For targets that fuzz targets run: libFuzzer must see which branches of TARGET an input takes.
function(carom_fuzzed target)
  if(carom_fuzz)
    target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link)
    target_link_options(${target} PUBLIC $<BUILD_INTERFACE:-fsanitize=fuzzer-no-link>)
  endif()
endfunction()

if(CAROM_COVERAGE AND NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  message(FATAL_ERROR "CAROM_COVERAGE=ON needs clang: cmake --preset asan, or -DCMAKE_CXX_COMPILER=clang++")
endif()
# With CAROM_COVERAGE, counts the executed lines of TARGET's own sources; all runs of a program add to one
# file (%m).
function(carom_count_lines target)
  if(CAROM_COVERAGE)
    set(counting -fprofile-instr-generate=${PROJECT_BINARY_DIR}/counts/%2m.profraw)
    target_compile_options(${target} PRIVATE ${counting} -fcoverage-mapping)
    target_link_options(${target} PUBLIC $<BUILD_INTERFACE:${counting}>)
  endif()
endfunction()

# Plain C++ for any processor, and on x86-64 two higher levels.
set(carom_instruction_sets scalar)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
  list(APPEND carom_instruction_sets v3 v4)
endif()
# Compiles the given sources once for every instruction set, with the options of TARGET and in the namespace
# CAROM_ISA_NAMESPACE (scalar is the compiler's default), and adds the objects to TARGET. Such sources include
# no Eigen and no std templates with code: the linker could choose a weak symbol built for a higher
# instruction set, which would crash the program on an older processor.
function(carom_per_instruction_set target)
  foreach(isa ${carom_instruction_sets})
    set(objects ${target}_${isa})
    add_library(${objects} OBJECT EXCLUDE_FROM_ALL ${ARGN})
    set_target_properties(${objects} PROPERTIES
      POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
    target_compile_definitions(${objects} PRIVATE CAROM_ISA_NAMESPACE=${isa})
    target_include_directories(${objects} PRIVATE $<TARGET_PROPERTY:${target},INCLUDE_DIRECTORIES>)
    # Vectors wider than a register are split and never cross a call, so warnings about their ABI do not
    # apply.
    target_compile_options(${objects} PRIVATE
      $<TARGET_PROPERTY:${target},COMPILE_OPTIONS> -Wno-psabi
      $<$<NOT:$<STREQUAL:${isa},scalar>>:-march=x86-64-${isa}>)
    target_link_libraries(${objects} PRIVATE carom_flags)
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${objects}>)
  endforeach()
endfunction()

# Common settings of the libraries: hidden symbols, so that a program that embeds carom exports none of them,
# and installed headers. TARGET is carom_NAME, with its headers in include/.
function(carom_library target)
  set_target_properties(${target} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  carom_count_lines(${target})
  if(CAROM_INSTALL)
    install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  endif()
endfunction()
