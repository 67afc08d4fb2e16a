// The hash of a record, from its parts in this order: for each ball the number of segments and the segments,
// then the events, then the duration.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/fnv.h"
#include "carom/engine/record.h"

namespace carom {

class RecordHash {
  public:
    void ball(std::size_t segments) { fnv_.add(static_cast<std::uint64_t>(segments)); }
    void segment(const Segment& s) {
        for (const double x :
             {s.start, s.r.x(), s.r.y(), s.r.z(), s.v.x(), s.v.y(), s.v.z(), s.w.x(), s.w.y(), s.w.z(),
              s.a.x(), s.a.y(), s.dw.x(), s.dw.y(), s.spin_decay, s.duration})
            fnv_.add(x);
        fnv_.add(static_cast<std::uint64_t>(s.state) + (s.held ? 256u : 0u));
    }
    void event(const Event& e) {
        fnv_.add(e.time);
        fnv_.add(static_cast<std::uint64_t>(e.type));
        fnv_.add(static_cast<std::uint64_t>(e.a) + 1);
        fnv_.add(static_cast<std::uint64_t>(e.b) + 1);
    }
    void duration(double seconds) { fnv_.add(seconds); }
    std::uint64_t value() const { return fnv_.value(); }

  private:
    Fnv fnv_;
};

}  // namespace carom
