// The impact by tolerance for v4.
#define CAROM_TOLERANCE_NAME tolerance_v4
#include "tolerance_impl.h"
