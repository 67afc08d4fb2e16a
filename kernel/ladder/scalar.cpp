// The rungs of the ladder for plain x86-64.
#define CAROM_LADDER_ISA scalar
#include "ladder/impl.h"
