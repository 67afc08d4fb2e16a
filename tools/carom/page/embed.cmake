# Writes scripts, styles and other files of pages into a C++ file:
# cmake "-DFILES=a.js;b.css" -DFUNCTION=page_files -DOUTPUT=page_files.cpp -P embed.cmake
#
# Scripts are ES modules, which node imports unchanged. A page that is opened from a file cannot load modules,
# so each becomes a script that reads its imports from the object `modules` and puts its exports there, under
# its file name without the folder. Comments, empty lines and indentation are left out, so no text between
# backticks may span lines.
include(${CMAKE_CURRENT_LIST_DIR}/../../../render/look.cmake)

# The script of a module, and the file names of its imports as a list of C++ strings.
function(module_script name source script imports)
  string(REGEX MATCHALL "\nimport [^\"]+\"[^\"]+" imported "\n${source}")
  list(TRANSFORM imported REPLACE ".*/" "")
  list(JOIN imported "\", \"" names)
  if(names)
    set(names "\"${names}\"")
  endif()
  string(REGEX MATCHALL "\nexport (async )?(function|class|const) [A-Za-z_]+" exported "\n${source}")
  list(TRANSFORM exported REPLACE ".* " "")
  list(JOIN exported ", " exported)
  string(REGEX REPLACE "\nimport ([^\"]+) from \"([^\"]+/)([A-Za-z_.]+)\";" "\nconst \\1 = modules[\"\\3\"];"
    source "\n${source}")
  string(REGEX REPLACE "(\n *|  )//[^\n]*|\n */[*]([^*]|[*][^/])*[*]/" "" source "${source}")
  string(REGEX REPLACE "\n[ \n]+" "\n" source "${source}")
  string(REPLACE "\nconst * as " "\nconst " source "${source}")
  string(REPLACE "\nexport " "\n" source "${source}")
  set(${script} "\"use strict\";\n(globalThis.modules ??= {})[\"${name}\"] = (() => {${source}
return {${exported}};\n})();\n" PARENT_SCOPE)
  set(${imports} "${names}" PARENT_SCOPE)
endfunction()

set(text "// Made by tools/carom/page/embed.cmake.\n#include \"page/page.h\"\n\n")
# The standard asks for 65536 characters only.
string(APPEND text "#pragma GCC diagnostic ignored \"-Woverlength-strings\"\n\n")
string(APPEND text "namespace carom::tools {\n\nconst std::vector<PageFile>& ${FUNCTION}() {\n")
string(APPEND text "    static const std::vector<PageFile> files = {\n")
foreach(path IN LISTS FILES)
  get_filename_component(name ${path} NAME)
  file(READ ${path} source)
  if(name STREQUAL look.h)
    carom_look(source "export const \\1 = [\\2]" "export const \\1 = \\2")
  endif()
  set(imports)
  if(name MATCHES "[.](js|h)$")
    module_script(${name} "${source}" source imports)
  endif()
  if(name MATCHES "[.]css$")
    string(REGEX REPLACE "\n +" " " source "${source}")
    foreach(sign " {" "{ " "; " ", ")
      string(STRIP "${sign}" bare)
      string(REPLACE "${sign}" "${bare}" source "${source}")
    endforeach()
  endif()
  if(name MATCHES "[.](vert|frag|glsl)$")
    string(REGEX REPLACE " *//[^\n]*" "" source "${source}")
    string(REGEX REPLACE "\n[ \n]+" "\n" source "${source}")
  endif()
  string(SHA256 hash "${source}")
  string(APPEND text "{\"${name}\", R\"page(${source})page\", \"${hash}\", {${imports}}},\n")
endforeach()
string(APPEND text "    };\n    return files;\n}\n\n}  // namespace carom::tools\n")
file(WRITE ${OUTPUT} "${text}")
