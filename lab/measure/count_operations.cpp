// Counts the operations per step of the kernel variants by compiling their source with a counting number
// type. It does not link the library, because here every `double` of the kernel is such a number.
#include <immintrin.h>

#include <cstdio>
#include <initializer_list>
#include <type_traits>

namespace counting {

struct Counts {
    long add = 0, mul = 0, fma = 0, div = 0, root = 0, rsqrt = 0, compare = 0;
} counts;

struct Counted {
    double value;
    constexpr Counted() : value(0.0) {}
    template <class T>
    requires(std::is_arithmetic_v<T>) constexpr Counted(T x) : value(static_cast<double>(x)) {}
    template <class T>
    requires(std::is_arithmetic_v<T>) constexpr explicit operator T() const { return static_cast<T>(value); }
};

constexpr void count(long Counts::*what) {
    if (!__builtin_is_constant_evaluated()) ++(counts.*what);
}
constexpr Counted operator+(Counted a, Counted b) {
    return count(&Counts::add), Counted(a.value + b.value);
}
constexpr Counted operator-(Counted a, Counted b) {
    return count(&Counts::add), Counted(a.value - b.value);
}
constexpr Counted operator*(Counted a, Counted b) {
    return count(&Counts::mul), Counted(a.value * b.value);
}
constexpr Counted operator/(Counted a, Counted b) {
    return count(&Counts::div), Counted(a.value / b.value);
}
constexpr Counted operator-(Counted a) {
    return Counted(-a.value);
}  // changes only the sign bit: not counted
constexpr Counted& operator+=(Counted& a, Counted b) {
    return a = a + b;
}
constexpr Counted& operator-=(Counted& a, Counted b) {
    return a = a - b;
}
constexpr Counted& operator*=(Counted& a, Counted b) {
    return a = a * b;
}
constexpr Counted& operator/=(Counted& a, Counted b) {
    return a = a / b;
}
constexpr bool operator<(Counted a, Counted b) {
    return count(&Counts::compare), a.value < b.value;
}
constexpr bool operator>(Counted a, Counted b) {
    return count(&Counts::compare), a.value > b.value;
}
constexpr bool operator<=(Counted a, Counted b) {
    return count(&Counts::compare), a.value <= b.value;
}
constexpr bool operator>=(Counted a, Counted b) {
    return count(&Counts::compare), a.value >= b.value;
}
constexpr bool operator==(Counted a, Counted b) {
    return count(&Counts::compare), a.value == b.value;
}
constexpr bool operator!=(Counted a, Counted b) {
    return count(&Counts::compare), a.value != b.value;
}

Counted counted_root(Counted a) {
    return count(&Counts::root), Counted(__builtin_sqrt(a.value));
}
Counted counted_fma(Counted a, Counted b, Counted c) {
    return count(&Counts::fma), Counted(__builtin_fma(a.value, b.value, c.value));
}
Counted counted_magnitude(Counted a) {
    return Counted(__builtin_fabs(a.value));
}
__m128 counted_rsqrt(__m128 a) {
    return count(&Counts::rsqrt), _mm_rsqrt_ss(a);
}

}  // namespace counting
using namespace counting;

#define double Counted
// NOLINTBEGIN(clang-diagnostic-reserved-macro-identifier): these calls are counted
#define __builtin_sqrt counted_root
#define __builtin_fma counted_fma
#define __builtin_fabs counted_magnitude
// NOLINTEND(clang-diagnostic-reserved-macro-identifier)
#define _mm_rsqrt_ss counted_rsqrt
#include "bench/five_states.h"
#include "ladder/branch_hints.h"
#include "ladder/branch_order.h"
#include "ladder/combined.h"
#include "ladder/explicit_fma.h"
#include "ladder/fewer_roots.h"
#include "ladder/precomputed.h"
#include "ladder/reduced.h"
#include "ladder/rsqrt.h"
#include "ladder/unconditional_roots.h"
#undef double

namespace {

using namespace carom::kernel;
using March = void (*)(const Ball&, const Ball&, const ImpactParams&, int, ImpactResult&);

void report(const char* name, March march) {
    static bool first = true;
    // The difference between two values of N, which leaves only the operations of the loop.
    double per_step[7] = {};
    long steps = 0;
    for (int n : {1000, 2000}) {
        for (const auto& state : carom::tools::kFiveStates) {
            counts = {};
            ImpactResult out;
            march(state.ball1, state.ball2, state.params, n, out);
            const double sign = n == 2000 ? 1.0 : -1.0;
            const long values[7] = {counts.add,  counts.mul,   counts.fma,    counts.div,
                                    counts.root, counts.rsqrt, counts.compare};
            for (int i = 0; i < 7; ++i) per_step[i] += sign * static_cast<double>(values[i]);
            steps += (n == 2000 ? 1 : -1) * out.steps;
        }
    }
    std::printf("%s{\"name\": \"%s\"", first ? "" : ",\n ", name);
    first = false;
    const char* names[7] = {"add", "mul", "fma", "div", "sqrt", "rsqrt", "compare"};
    for (int i = 0; i < 7; ++i)
        std::printf(", \"%s\": %.2f", names[i], per_step[i] / static_cast<double>(steps));
    std::printf("}");
}

template <class Variant>
void variant(const Ball& a, const Ball& b, const ImpactParams& p, int n, ImpactResult& out) {
    drive<Variant>(a, b, p, n, out);
}

}  // namespace

int main() {
    std::printf("{\"per_step\": [\n ");
    report("baseline", variant<PublishedMarch>);
    report("fewer square roots", variant<FewerRoots>);
    report("rsqrt", variant<RsqrtRaw>);
    report("rsqrt newton", variant<RsqrtNewton>);
    report("branch hints", variant<BranchHints>);
    report("branch order", variant<BranchOrder>);
    report("unconditional roots", variant<UnconditionalRoots>);
    report("two stages", variant<TwoStage>);
    report("precomputed", variant<Precomputed>);
    report("fma", variant<ExplicitFma>);
    report("combined", variant<Combined>);
    report("reduced state", variant<ReducedState>);
    std::printf("]}\n");
}
