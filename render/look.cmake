# The constants of carom/render/look.h in another language, one per line.
# carom_look(OUT COLOR NUMBER): the forms of a colour and of a number; \1 is the name and \2 the value.
set(carom_look_header ${CMAKE_CURRENT_LIST_DIR}/include/carom/render/look.h)
function(carom_look out color number)
  file(READ ${carom_look_header} text)
  string(REGEX MATCHALL "constexpr (Color|double) k[A-Za-z]+([{][^}]*[}]| = [0-9.]+)" found "${text}")
  set(lines "")
  foreach(one IN LISTS found)
    string(REGEX REPLACE "^constexpr Color (k[A-Za-z]+)[{]([^}]*)[}]" "${color}" one "${one}")
    string(REGEX REPLACE "^constexpr double (k[A-Za-z]+) = ([0-9.]+)" "${number}" one "${one}")
    string(APPEND lines "${one};\n")
  endforeach()
  set(${out} "${lines}" PARENT_SCOPE)
endfunction()
function(carom_look_glsl out)
  carom_look(text "const vec3 \\1 = vec3(\\2)" "const float \\1 = \\2")
  set(${out} "${text}" PARENT_SCOPE)
endfunction()

# As a script, it prints them for GLSL.
if(CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
  carom_look_glsl(text)
  message("${text}")
endif()
