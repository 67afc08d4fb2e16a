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
    /// All zero.
    explicit Complementarity(std::size_t n) : A(n * n, 0.0), q(n, 0.0), z(n, 0.0), size(n) {}

    /// Block principal pivoting: exchanges all infeasible rows while their number decreases, otherwise one row
    /// (Murty's rule), which terminates for every P-matrix (Judice and Pires, "A block principal pivoting
    /// algorithm for large-scale strictly monotone linear complementarity problems", 1994). The diagonal is
    /// increased by kContactSoftness of itself, so that redundant contacts (a ball in three of them) share their
    /// load evenly and the solution is unique; iterative refinement removes this effect again, down to rounding.
    /// @return false if no solution was found within the bound on pivots (A is not a P-matrix); z is then 0
    bool solve();

    double& at(std::size_t row, std::size_t column) { return A[row * size + column]; }
    double at(std::size_t row, std::size_t column) const { return A[row * size + column]; }

    std::vector<double> A;  ///< by rows
    std::vector<double> q;
    std::vector<double> z;  ///< result
    std::size_t size;

  private:
    bool factor();
    void back_substitute(std::vector<double>& x) const;
    void residual(std::vector<double>& w) const;
    double worst_residual(const std::vector<double>& w) const;
    void solve_basic(std::vector<double>& w);
    void refine(std::vector<double>& w);
    void extrapolate(std::vector<double>& w);

    std::vector<char> basic_;
    std::vector<std::size_t> index_, pivot_;
    std::vector<double> lu_, part_, before_, last_;
};

}  // namespace carom
