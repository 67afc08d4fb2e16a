// Where exceptions become a status and a message.
#pragma once

#include <initializer_list>
#include <stdexcept>

#include "carom/carom.h"
#include "carom/kernel/isa.h"

namespace carom::c {

/// CAROM_BAD_ARGUMENT; what() says which and why.
class BadArgument : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Keeps the message of the exception that is being handled. @returns the status that it stands for
carom_status keep_error() noexcept;

/// Runs what may throw.
template <class Work>
carom_status guarded(Work&& work) noexcept {
    try {
        work();
        return CAROM_OK;
    } catch (...) {
        return keep_error();
    }
}

/// @throws BadArgument if one of them is null
void need(std::initializer_list<const void*> pointers);

/// CAROM_ISA or the widest one. @throws BadArgument for a name that cannot be run here
kernel::Isa chosen_isa();

}  // namespace carom::c
