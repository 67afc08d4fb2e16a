// If threads cannot be started, the result is an error, not the end of the program.
#include "frames/writer.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include "carom/render/error.h"

namespace carom::render {
namespace {

/// While it exists, every new thread uses 256 MiB of addresses, and only two fit.
class RoomForTwoThreads {
  public:
    RoomForTwoThreads() {
        constexpr std::size_t kStack = std::size_t{256} << 20;
        pthread_attr_t attributes;
        pthread_getattr_default_np(&attributes_);
        pthread_attr_init(&attributes);
        pthread_attr_setstacksize(&attributes, kStack);
        pthread_setattr_default_np(&attributes);
        pthread_attr_destroy(&attributes);
        ::getrlimit(RLIMIT_AS, &limit_);
        std::size_t pages = 0;
        std::ifstream("/proc/self/statm") >> pages;
        const std::size_t used = pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
        const rlimit low{used + 5 * kStack / 2, limit_.rlim_max};
        set_ = ::setrlimit(RLIMIT_AS, &low) == 0;
    }
    ~RoomForTwoThreads() {
        ::setrlimit(RLIMIT_AS, &limit_);
        pthread_setattr_default_np(&attributes_);
        pthread_attr_destroy(&attributes_);
    }
    RoomForTwoThreads(const RoomForTwoThreads&) = delete;
    RoomForTwoThreads& operator=(const RoomForTwoThreads&) = delete;
    bool set() const { return set_; }

  private:
    pthread_attr_t attributes_{};
    rlimit limit_{};
    bool set_ = false;
};

TEST(FrameWriter, AFailedThreadStartIsAnError) {
    SequenceOptions options;
    options.size = {64, 64};
    std::string message;
    {
        const RoomForTwoThreads room;
        ASSERT_TRUE(room.set());
        try {
            const FrameWriter writer(options, 16);
        } catch (const RenderError& error) {
            message = error.what();
        }
    }
    EXPECT_TRUE(message.rfind("only 1 of 16 threads could be started (", 0) == 0 ||
                message.rfind("only 2 of 16 threads could be started (", 0) == 0)
        << message;
    EXPECT_NE(message.find("; use fewer with --jobs"), std::string::npos) << message;
    FrameWriter again(options, 3);
    again.finish();
}

}  // namespace
}  // namespace carom::render
