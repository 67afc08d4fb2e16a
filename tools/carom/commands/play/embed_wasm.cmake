# Writes carom.wasm, which is base64 of gzip in the file WASM, into a C++ file. Without WASM, the text is
# empty:
# cmake -DWASM=carom.wasm.gz.b64 -DOUTPUT=play_wasm.cpp -P embed_wasm.cmake
set(text)
if(WASM)
  file(READ ${WASM} text)
  string(STRIP "${text}" text)
endif()
file(WRITE ${OUTPUT} "// Made by tools/carom/commands/play/embed_wasm.cmake.
#include \"commands/play/play_wasm.h\"

// The standard asks for 65536 characters only.
#pragma GCC diagnostic ignored \"-Woverlength-strings\"

namespace carom::tools {

const char* const kPlayWasm = \"${text}\";

}  // namespace carom::tools
")
