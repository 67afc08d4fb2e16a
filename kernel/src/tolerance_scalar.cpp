// The impact by tolerance for scalar.
#define CAROM_TOLERANCE_NAME tolerance_scalar
#include "tolerance_impl.h"
