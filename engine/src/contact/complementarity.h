// Dense linear complementarity problems of a few dozen unknowns: the steps of Newton's method for the impulses in a group of
// resting contacts.
#pragma once

#include <cstddef>
#include <vector>

namespace carom {

/// [-] Compliance of each contact of a group, relative to its mobility (the diagonal of A). It makes the solution
/// unique: redundant contacts share the load.
inline constexpr double kContactSoftness = 1e-12;

/// z >= 0, w = A z + q >= 0, z . w = 0.
struct Complementarity {
    /// All zero, in the memory that it has.
    void resize(std::size_t n) {
        A.assign(n * n, 0.0);
        q.assign(n, 0.0);
        z.assign(n, 0.0);
        size = n;
    }

    /// Block principal pivoting: exchanges all infeasible rows while their number decreases, otherwise one row
    /// (Murty's rule), which terminates for every P-matrix (Judice and Pires, "A block principal pivoting
    /// algorithm for large-scale strictly monotone linear complementarity problems", 1994). The diagonal is
    /// increased by kContactSoftness of itself, so that redundant contacts (a ball in three of them) share their
    /// load evenly and the solution is unique; iterative refinement removes this effect again, down to rounding.
    /// It begins with the rows in which z is positive or A z + q negative.
    /// @return false if no solution was found within the bound on pivots (A is not a P-matrix); z is then 0
    bool solve();

    double& at(std::size_t row, std::size_t column) { return A[column * size + row]; }
    double at(std::size_t row, std::size_t column) const { return A[column * size + row]; }

    std::vector<double> A;  ///< by columns
    std::vector<double> q;
    std::vector<double> z;  ///< guess and result
    std::size_t size = 0;

  private:
    bool factor();
    void back_substitute(std::vector<double>& x) const;
    void residual(std::vector<double>& w) const;
    double worst_residual(const std::vector<double>& w) const;
    /// @param refined  whether each answer is refined, or only one that is right
    bool exchange(std::size_t most, bool refined);
    void find_wrong(const std::vector<double>& w);
    void polish(std::vector<double>& w);
    void refine(std::vector<double>& w);
    void extrapolate(std::vector<double>& w);

    std::vector<char> basic_;
    std::vector<std::size_t> index_, pivot_, wrong_;
    std::vector<double> lu_, w_, part_, before_, last_;
};

}  // namespace carom
