// A film that ffmpeg encodes frame by frame.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

#include "base/output_file.h"
#include "carom/engine/frame_size.h"
#include "carom/render/sequence.h"

namespace carom::tools {

/// One kind of film, recognised by the extension of its name.
struct FilmKind {
    const char* ending;
    const char* muxer;        ///< ffmpeg's name for the format
    render::RawFormat input;  ///< what ffmpeg receives
    const char* options;      ///< for ffmpeg, separated by spaces
    bool even = false;        ///< width and height must be even
    double fastest = 0.0;     ///< most frames per second; 0: no limit
};

/// The kind of film for this file name, or null if it is not a film.
const FilmKind* film_kind(const std::string& path);

/// @throws std::runtime_error naming the package if ffmpeg is missing
void require_ffmpeg(const std::string& path);

/// Runs ffmpeg, which writes to a temporary name. The film gets its own name when it is complete.
class Film {
  public:
    /// Starts ffmpeg. @throws std::runtime_error naming the film
    Film(const std::string& path, const FilmKind& kind, FrameSize size, double fps);
    /// Ends ffmpeg if it still runs. Without commit(), no film is left.
    ~Film();
    Film(const Film&) = delete;
    Film& operator=(const Film&) = delete;

    /// Passes the next bytes to ffmpeg. May be called from another thread.
    /// @throws Interrupted, std::runtime_error if ffmpeg failed
    void write(const std::uint8_t* bytes, std::size_t count);

    /// Waits until ffmpeg is done and names the film. @throws
    /// Interrupted, std::runtime_error if ffmpeg failed
    void commit();

  private:
    void end();
    void start(const FilmKind& kind, FrameSize size, double fps);
    int wait_for_end();                  ///< its status, as from waitpid()
    [[noreturn]] void fail(int status);  ///< with the last line ffmpeg wrote

    std::string path_;
    OutputFile file_;
    std::FILE* messages_;  ///< what ffmpeg writes to standard error
    int pipe_ = -1;        ///< to ffmpeg
    pid_t child_ = -1;     ///< ffmpeg, while it runs
};

}  // namespace carom::tools
