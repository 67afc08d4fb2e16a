// The rungs of the ladder for x86-64-v4 (AVX-512).
#define CAROM_LADDER_ISA v4
#include "ladder/impl.h"
