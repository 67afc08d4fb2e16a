# Writes the validation cases into one C++ file:
# cmake -DFOLDER=lab/data/validation -DOUTPUT=cases.cpp -P embed.cmake
file(GLOB shots ${FOLDER}/V*.toml)
file(GLOB breaks ${FOLDER}/B*.toml)
set(text "// Made by lab/carom/validate/embed.cmake from lab/data/validation.\n")
string(APPEND text "#include \"validate/case.h\"\n\nnamespace carom::tools {\n\n")
string(APPEND text
  "const std::vector<CaseFile>& case_files() {\n    static const std::vector<CaseFile> files = {\n")
foreach(path IN LISTS shots breaks)
  get_filename_component(name ${path} NAME)
  file(READ ${path} source)
  string(APPEND text "{\"${name}\", R\"case(${source})case\"},\n")
endforeach()
string(APPEND text "    };\n    return files;\n}\n\n}  // namespace carom::tools\n")
file(WRITE ${OUTPUT} "${text}")
