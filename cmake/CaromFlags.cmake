# carom_flags: what every target of the project is compiled with.
#
# -ffp-contract=off: a fused multiply-add happens only where the source says std::fma or an intrinsic, so that
# gcc and clang, debug and release, and every instruction set give the same bits (design: numbers).
add_library(carom_flags INTERFACE)
target_compile_features(carom_flags INTERFACE cxx_std_20)
target_compile_options(carom_flags INTERFACE
  -ffp-contract=off
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor)
# A test's own code is watched for what it does with memory and threads only: undefined behaviour is looked for, and branches
# are shown to the fuzzer, in what is tested. Tests compile in three quarters of the time this way.
if(CAROM_SANITIZE STREQUAL "address")
  set(carom_test_sanitizers address)
  set(carom_sanitizers address,undefined)
  # clang's libFuzzer needs to see which branches an input takes; the tests and the fuzz targets share one build.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    set(carom_sanitizers fuzzer-no-link,address,undefined)
  endif()
elseif(CAROM_SANITIZE STREQUAL "thread")
  set(carom_test_sanitizers thread)
  set(carom_sanitizers thread)
elseif(CAROM_SANITIZE)
  message(FATAL_ERROR "CAROM_SANITIZE=${CAROM_SANITIZE}: expected OFF, address or thread")
endif()
set(carom_of_a_test "$<BOOL:$<TARGET_PROPERTY:carom_is_a_test>>")
if(carom_sanitizers)
  target_compile_options(carom_flags INTERFACE
    -fsanitize=$<IF:${carom_of_a_test},${carom_test_sanitizers},${carom_sanitizers}>
    -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(carom_flags INTERFACE -fsanitize=${carom_sanitizers})
  # For tests of what a sanitizer changes: memory, mostly.
  target_compile_definitions(carom_flags INTERFACE CAROM_SANITIZED)
endif()
# Counts which lines of TARGET's own sources run, where CAROM_COVERAGE is on. Counts belong to the objects that write them: those
# of an earlier build are removed with it.
function(carom_count_lines target)
  if(CAROM_COVERAGE)
    target_compile_options(${target} PRIVATE --coverage)
    target_link_options(${target} PUBLIC $<BUILD_INTERFACE:--coverage>)
    add_custom_command(TARGET ${target} PRE_LINK
      COMMAND find ${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/${target}.dir -name *.gcda -delete VERBATIM)
  endif()
endfunction()

# Compiles SOURCE for one x86-64 level. Such files include no Eigen and no std templates with code: a weak symbol
# built for the higher level could win at link time and crash an older machine.
function(carom_compile_for_level source level)
  set_source_files_properties(${source} PROPERTIES COMPILE_OPTIONS "-march=x86-64-${level}")
endfunction()

# What every library of the project is: hidden symbols, so that a program that embeds it shows none of ours, and headers
# that are installed. TARGET carom_NAME has its headers in include/.
function(carom_library target)
  set_target_properties(${target} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  carom_count_lines(${target})
  if(CAROM_INSTALL)
    install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  endif()
endfunction()
