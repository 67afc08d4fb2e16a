// Heap allocations of the event loop, counted by a replaced operator new.
#include <box2d/b2_dynamic_tree.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <string>

#include "carom/engine/batch.h"
#include "carom/kernel/splitmix64.h"
#include "support/gas.h"
#include "support/scenes.h"

namespace {
std::atomic<long> allocations{0}, bytes{0};

void* counted(std::size_t size) {
    ++allocations;
    bytes += static_cast<long>(size);
    if (void* p = std::malloc(size == 0 ? 1 : size)) return p;
    throw std::bad_alloc();
}
void* counted(std::size_t size, std::align_val_t align) {
    ++allocations;
    bytes += static_cast<long>(size);
    const auto a = static_cast<std::size_t>(align);
    if (void* p = std::aligned_alloc(a, (size + a - 1) / a * a)) return p;
    throw std::bad_alloc();
}
}  // namespace

void* operator new(std::size_t size) {
    return counted(size);
}
void* operator new[](std::size_t size) {
    return counted(size);
}
// std::stable_partition allocates its buffers here. A sanitizer's own version would not match free().
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    try {
        return counted(size);
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}
void* operator new(std::size_t size, std::align_val_t align) {
    return counted(size, align);
}
void* operator new[](std::size_t size, std::align_val_t align) {
    return counted(size, align);
}
void operator delete(void* p) noexcept {
    std::free(p);
}
void operator delete[](void* p) noexcept {
    std::free(p);
}
void operator delete(void* p, std::size_t) noexcept {
    std::free(p);
}
void operator delete[](void* p, std::size_t) noexcept {
    std::free(p);
}
void operator delete(void* p, std::align_val_t) noexcept {
    std::free(p);
}
void operator delete[](void* p, std::align_val_t) noexcept {
    std::free(p);
}
void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
    std::free(p);
}
void operator delete[](void* p, std::size_t, std::align_val_t) noexcept {
    std::free(p);
}

namespace carom {
namespace {

using namespace test;

// Counts after the first and the last round of the loop: their difference is the loop alone.
struct LoopCount {
    long first = -1, last = 0, first_bytes = 0;
    std::size_t events = 0;

    explicit LoopCount(const Plan& plan) {
        SimulateOptions options;
        options.progress_rounds = 1;
        options.progress = [this](std::size_t n, double) {
            last = allocations;
            if (first < 0) {
                first = last;
                first_bytes = bytes;
            }
            events = n;
        };
        const long before = bytes;
        simulate(plan, options);
        first_bytes -= before;
    }
    long in_loop() const { return last - first; }
};

Scene eight_ball_break(ClusterModel clusters) {
    Scene scene = read_scene(std::string(CAROM_SOURCE_DIR) + "/scenes/eight_ball_break.toml");
    scene.physics.clusters = clusters;
    // No two balls stay in contact at this aim.
    scene.cue->aim_deg = 90.08;
    return scene;
}

TEST(Memory, NoAllocationInTheLoopOfABreak) {
    const LoopCount count(plan_of(eight_ball_break(ClusterModel::kSequential)));
    EXPECT_GT(count.events, 80u);
    EXPECT_EQ(count.in_loop(), 0);
}

// A rack's first cluster is the largest; later ones reuse its scratch memory.
TEST(Memory, NoAllocationInTheLoopOfABreakWithClusters) {
    const LoopCount count(plan_of(eight_ball_break(ClusterModel::kCompliant)));
    EXPECT_GT(count.events, 50u);
    EXPECT_EQ(count.in_loop(), 0);
}

TEST(Memory, NoAllocationInTheLoopOfAShot) {
    for (const char* file : {"draw", "hello", "three_cushion", "stop"}) {
        const LoopCount count(plan_of(shipped(file)));
        EXPECT_EQ(count.in_loop(), 0) << file;
    }
}

bool has_resting_contacts(const Record& record) {
    return std::any_of(record.events.begin(), record.events.end(),
                       [](const Event& e) { return kind(e.type).phase == EventPhase::kHold; });
}

// In a batch, the memory of the first shots suffices for the others, unless balls rest against something.
TEST(Memory, NoAllocationInABatchAfterTheFirstShots) {
    for (const char* file : {"draw", "three_cushion", "side_bank", "eight_ball_break"}) {
        const Scene scene = shipped(file);
        const SceneNumber aim(scene, "cue.aim_deg"), speed(scene, "cue.speed"),
            side(scene, "cue.offset.side"), mu_r(scene, "balls.mu_r"),
            x(scene, "ball." + scene.cue->ball + ".position.x");
        Simulator simulator(scene, kernel::Isa::kScalar);
        SplitMix64 random(1);
        const double own = scene.ball[0].position.x();
        int results = 0, without_memory = 0;
        for (int shot = 0; shot < 200; ++shot) {
            Scene& s = simulator.scene();
            SimulateOptions options;
            options.hash = shot % 3 == 0;
            const long before = allocations;
            Change change = aim.put(s, 80.0 + 20.0 * random.uniform());
            change = std::max(change, speed.put(s, 1.0 + 5.0 * random.uniform()));
            change = std::max(change, side.put(s, shot % 2 * 0.1));
            change = std::max(change, mu_r.put(s, 0.008 + 0.004 * random.uniform()));
            change = std::max(change, x.put(s, own + 0.001 * random.uniform()));
            results += has_result(simulator.play(change, options));
            if (shot < 20) continue;
            without_memory += allocations == before;
            if (allocations == before) continue;
            // A shot that is longer, or has a larger cluster, than all before needs longer lists, but only
            // the first time.
            const long once_more = allocations;
            simulator.play(change, options);
            const long more = allocations - once_more;
            EXPECT_TRUE(more == 0 || has_resting_contacts(simulate(plan_of(s)))) << file << ' ' << shot;
        }
        EXPECT_EQ(results, 200) << file;
        EXPECT_GT(without_memory, 100) << file;
    }
}

// A long run only doubles the log of segments and the list of events.
TEST(Memory, ALongRunOnlyDoublesItsLog) {
    for (const int n : {16, 100, 900}) {
        const LoopCount count(plan_of(gas(n, 20000, 3)));
        EXPECT_EQ(count.events, 20000u);
        // Three lists start with room for 256 or more, so each doubles at most log2(40000 / 256) + 1 times.
        EXPECT_LE(count.in_loop(), 3 * 9) << n;
        EXPECT_GT(count.in_loop(), 0) << n;
    }
}

// Set-up is linear in the balls. Counted is all that operator new allocated, even if freed since; the nodes
// of Box2D's tree come from malloc and are added: at most four per block of 64 boxes, because its list
// doubles.
TEST(Memory, UnderAKilobyteABall) {
    double per_ball[2];
    int k = 0;
    for (const int n : {2500, 10000}) {
        const LoopCount count(plan_of(gas(n, 10, 3)));
        per_ball[k++] = static_cast<double>(count.first_bytes) / n;
    }
    EXPECT_LT(per_ball[1] + 4.0 * sizeof(b2TreeNode) / 64.0, 1000.0);
    EXPECT_LT(per_ball[1], 1.05 * per_ball[0]);
    if (std::getenv("CAROM_RESIDUALS") != nullptr)
        std::printf("bytes a ball: %.0f of 2500, %.0f of 10000\n", per_ball[0], per_ball[1]);
}

}  // namespace
}  // namespace carom
