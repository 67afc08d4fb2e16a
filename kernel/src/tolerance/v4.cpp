// Impacts by tolerance, single and in batches, for x86-64-v4: compiled with -march=x86-64-v4.
#define CAROM_TOLERANCE_NAME tolerance_v4
#define CAROM_TOLERANCE_BATCH_NAME tolerance_batch_v4
#include "tolerance/batch_impl.h"
