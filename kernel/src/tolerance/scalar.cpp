// Impacts by tolerance, single and in batches, for plain x86-64.
#define CAROM_TOLERANCE_NAME tolerance_scalar
#define CAROM_TOLERANCE_BATCH_NAME tolerance_batch_scalar
#include "tolerance/batch_impl.h"
