// Memory that outlives a run.
#pragma once

#include <utility>

namespace carom {

/// Takes memory over for its own lifetime, then returns it for the next run. A derived class has the members
/// of `Memory` as its own.
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
