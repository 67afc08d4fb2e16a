// The surroundings of main.cpp in the program for node; see system.jslib.
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>

extern "C" {

char* carom_page_wasm();
pid_t carom_getpid();
int carom_flock(int fd);

// The functions of emscripten are only stubs.
pid_t getpid() {
    return carom_getpid();
}
int flock(int fd, int) {
    const int error = -carom_flock(fd);
    if (error == 0) return 0;
    errno = error;
    return -1;
}

/// 1 while the program waits for its input: then a signal must end it.
int* carom_reads_input() {
    static int reads = 0;
    return &reads;
}
}

namespace carom::tools {

// carom.wasm is beside the program.
std::string page_wasm() {
    char* const text = carom_page_wasm();
    std::string wasm = text;
    std::free(text);
    return wasm;
}

}  // namespace carom::tools
