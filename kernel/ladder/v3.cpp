// The rungs of the ladder for x86-64-v3 (AVX2, FMA).
#define CAROM_LADDER_ISA v3
#include "ladder/impl.h"
