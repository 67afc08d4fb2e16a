// The march for x86-64-v3 (AVX2, FMA): compiled with -march=x86-64-v3.
#define CAROM_MARCH_NAME march_v3
#include "march/impl.h"
