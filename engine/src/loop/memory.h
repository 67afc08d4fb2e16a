// Memory that outlives a run.
#pragma once

#include <utility>

namespace carom {

/// Takes over memory as long as it lives and then puts it back, so that the next
/// one finds it. What derives from it has the lists of `Memory` as its own.
template <class Memory>
class Borrowed : protected Memory {
  public:
    explicit Borrowed(Memory& owner) : Memory(std::move(owner)), owner_(owner) {}
    ~Borrowed() { owner_ = std::move(static_cast<Memory&>(*this)); }
    Borrowed(const Borrowed&) = delete;
    Borrowed& operator=(const Borrowed&) = delete;

  private:
    Memory& owner_;
};

}  // namespace carom
