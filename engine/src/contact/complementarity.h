// Linear complementarity problems of a few dozen unknowns: one Newton step for the impulses in a group of
// resting contacts.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// z >= 0, w = A z + q >= 0, z . w = 0.
struct Complementarity {
    /// Sets n unknowns and no columns, in existing memory.
    void resize(std::size_t n) {
        q.assign(n, 0.0);
        z.assign(n, 0.0);
        size = n;
        clear();
    }
    void clear() {
        entries.clear();
        first.clear();
    }
    /// Adds the next column of A: begin_column(), then its entries, each row once, including the diagonal.
    /// Omitted entries are zero (contacts without a common ball).
    void begin_column() { first.push_back(entries.size()); }
    void add(std::size_t row, double value) { entries.push_back({row, value}); }
    /// result += A x, column by column.
    void multiply_add(double factor, const std::vector<double>& x, std::vector<double>& result) const;

    /// Block principal pivoting: exchanges all infeasible rows while their number decreases, otherwise one
    /// row (Murty's rule), which terminates for every P-matrix (Judice and Pires, "A block principal pivoting
    /// algorithm for large-scale strictly monotone linear complementarity problems", 1994). The diagonal is
    /// increased by kContactSoftness of itself, so that the solution is unique and redundant contacts (a ball
    /// in three of them) share their load evenly; iterative refinement then removes this effect down to
    /// rounding. Starts with the rows in which z is positive or A z + q negative.
    /// @return false if no solution was found (none may exist); z is then 0
    bool solve();

    struct Entry {
        std::size_t row;
        double value;
    };
    std::vector<Entry> entries;      ///< of A, by columns
    std::vector<std::size_t> first;  ///< of each column
    std::vector<double> q;
    std::vector<double> z;  ///< initial guess, then result
    std::size_t size = 0;

  private:
    std::size_t end_of(std::size_t c) const { return c + 1 < first.size() ? first[c + 1] : entries.size(); }
    std::span<const Entry> column(std::size_t c) const {
        return {entries.data() + first[c], end_of(c) - first[c]};
    }
    bool factor();
    void back_substitute(std::vector<double>& x) const;
    void residual(std::vector<double>& w) const;
    double worst_residual(const std::vector<double>& w);
    void add_sizes();
    bool exchange(std::size_t most);
    bool approach();
    void find_wrong(const std::vector<double>& w);
    void polish(std::vector<double>& w);
    void refine(std::vector<double>& w);

    std::vector<char> basic_;
    std::vector<std::size_t> index_, pivot_, wrong_;
    std::vector<std::size_t> place_;         // of a basic row in index_
    std::vector<std::size_t> top_, bottom_;  // first and last row of a column of lu_ that is not zero
    std::vector<double> lu_, w_, part_, last_, size_of_;
};

}  // namespace carom
