// The march for x86-64-v4 (AVX-512): compiled with -march=x86-64-v4.
#define CAROM_MARCH_NAME march_v4
#include "march/impl.h"
