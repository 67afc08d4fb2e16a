// The contact phase for x86-64-v3: compiled with -march=x86-64-v3.
#define CAROM_CONTACT_PHASE_NAME contact_phase_v3
#include "contact_phase/impl.h"
