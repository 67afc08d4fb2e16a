// One step of Dormand and Prince, J. Comp. Appl. Math. 6 (1980), RK5(4)7M.
#pragma once

namespace carom::detail {

/// A coefficient of the tableau. h is multiplied first and divided afterwards: this order determines the bits
/// of the results.
struct Fraction {
    double numerator, denominator;
};
inline constexpr Fraction kStages[6][6] = {
    {{1, 5}},
    {{3, 40}, {9, 40}},
    {{44, 45}, {-56, 15}, {32, 9}},
    {{19372, 6561}, {-25360, 2187}, {64448, 6561}, {-212, 729}},
    {{9017, 3168}, {-355, 33}, {46732, 5247}, {49, 176}, {-5103, 18656}},
    {{35, 384}, {0, 1}, {500, 1113}, {125, 192}, {-2187, 6784}, {11, 84}},
};
inline constexpr Fraction kError[7] = {{71, 57600},      {0, 1},    {-71, 16695}, {71, 1920},
                                       {-17253, 339200}, {22, 525}, {-1, 40}};

template <class State>
struct DormandPrinceStep {
    State next;
    State slope;  ///< at `next`: the first slope of the next step
    State error;  ///< fourth order minus fifth
};

/// y + h (sum of k times the row), from the left.
template <class State, int kCount>
State along_row(const State& y, double h, const Fraction (&row)[kCount], const State (&k)[7], int count) {
    State sum = y;
    for (int i = 0; i < count; ++i)
        if (row[i].numerator != 0.0) sum = plus(sum, h * row[i].numerator / row[i].denominator, k[i]);
    return sum;
}

/// @param slope  State -> State, the right-hand side; k1 is its value at y
template <class State, class Slope>
DormandPrinceStep<State> dormand_prince(const State& y, double h, const State& k1, const Slope& slope) {
    State k[7] = {k1};
    DormandPrinceStep<State> step;
    for (int stage = 1; stage < 7; ++stage) {
        step.next = along_row(y, h, kStages[stage - 1], k, stage);
        k[stage] = slope(step.next);
    }
    step.slope = k[6];
    step.error = along_row(State{}, h, kError, k, 7);
    return step;
}

}  // namespace carom::detail
