// carom.wasm for the page to play on.
#pragma once

namespace carom::tools {

/// Base64 of gzip; empty in a program that was built without it.
extern const char* const kPlayWasm;

}  // namespace carom::tools
