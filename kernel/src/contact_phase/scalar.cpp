// The contact phase for plain x86-64.
#define CAROM_CONTACT_PHASE_NAME contact_phase_scalar
#include "contact_phase/impl.h"
