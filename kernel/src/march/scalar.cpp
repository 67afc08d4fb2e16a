// The march for plain x86-64.
#define CAROM_MARCH_NAME march_scalar
#include "march/impl.h"
