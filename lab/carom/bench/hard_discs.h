// Elastic hard discs in a box, as in molecular dynamics: the code that `carom-lab bench discs` compares with
// carom. Cell lists find the neighbours, every disc has one predicted event, and a binary heap orders the
// events. Only its own events move a disc.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "carom/engine/vec.h"

namespace carom::tools {

class HardDiscs {
  public:
    /// Discs of equal mass, whose centres bounce at the distance `reach` and at the borders of the box from 0
    /// to `size`.
    HardDiscs(std::vector<Vec2> places, std::vector<Vec2> velocities, double reach, const Vec2& size);

    /// Plays up to this number of collisions since the start. @returns the time of the last one [s]
    double run(long collisions);

    /// Number of collisions of two discs, and of a disc and a border, since the start.
    long collisions() const { return collisions_; }

  private:
    static constexpr double kNever = std::numeric_limits<double>::infinity();
    static constexpr int kBorder = -1, kCell = -2, kNothing = -3;
    struct Disc {
        Vec2 r, v;      // at its own time
        double time;    // of r [s]
        double event;   // time of its next event [s]
        int partner;    // a disc, or one of the constants
        int axis, way;  // of a border or cell: 0 or 1; -1 or 1
        int column, row;
        int previous, next;  // in the list of its cell
        std::size_t place;   // in the heap
    };

    int& head(int column, int row) { return heads_[static_cast<std::size_t>(row * columns_ + column)]; }
    void enter(int i);
    void leave(int i);
    void move(Disc& disc, double time);
    void predict(int i, double now);
    double time_to(const Disc& a, const Disc& b, double now) const;
    void collide(Disc& a, Disc& b);
    void set(int i, double time);
    void rise(std::size_t place, int i);
    void sink(std::size_t place, int i);

    double reach_;
    Vec2 size_, cell_;
    int columns_, rows_;
    std::vector<Disc> discs_;
    std::vector<int> heads_, heap_;
    long collisions_ = 0;
};

}  // namespace carom::tools
