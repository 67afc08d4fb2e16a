// The impact by tolerance for v3.
#define CAROM_TOLERANCE_NAME tolerance_v3
#include "tolerance_impl.h"
