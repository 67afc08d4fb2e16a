# cmake -DPROGRAM=carom -DSOURCE=repository -DBINARY=folder -DCOMPILER=c++ -P compare.cmake
#
# Builds the debug twin and runs every scene with both: the release on the widest instruction set, the twin on
# the narrowest and the widest. All must give the same hash.
function(run_or_fail)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "failed: ${ARGN}\n${output}")
  endif()
endfunction()

function(hash_of result isa)
  set(ENV{CAROM_ISA} "${isa}")
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output
    OUTPUT_STRIP_TRAILING_WHITESPACE)
  string(LENGTH "${output}" length)
  if(NOT status EQUAL 0 OR NOT length EQUAL 16)
    message(FATAL_ERROR "no hash from: ${ARGN}\n${output}")
  endif()
  set(${result} ${output} PARENT_SCOPE)
endfunction()

run_or_fail(${CMAKE_COMMAND} -G Ninja -S ${SOURCE}/tests/tools/debug_twin -B ${BINARY}
  -DCMAKE_BUILD_TYPE=Debug -DCMAKE_UNITY_BUILD=ON -DCMAKE_CXX_COMPILER=${COMPILER})
run_or_fail(${CMAKE_COMMAND} --build ${BINARY} --target hash)

file(GLOB scenes ${SOURCE}/scenes/*.toml)
list(LENGTH scenes count)
if(count EQUAL 0)
  message(FATAL_ERROR "no scene in ${SOURCE}/scenes")
endif()
foreach(scene IN LISTS scenes)
  hash_of(release "" ${PROGRAM} simulate ${scene} --hash)
  foreach(isa scalar "")
    hash_of(debug "${isa}" ${BINARY}/hash ${scene})
    if(NOT debug STREQUAL release)
      message(FATAL_ERROR "${scene}: release ${release}, debug (${isa}) ${debug}")
    endif()
  endforeach()
  message(STATUS "${release} ${scene}")
endforeach()
