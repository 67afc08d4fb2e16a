// The contact phase for x86-64-v4: compiled with -march=x86-64-v4.
#define CAROM_CONTACT_PHASE_NAME contact_phase_v4
#include "contact_phase/impl.h"
