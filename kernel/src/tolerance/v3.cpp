// Impacts by tolerance, single and in batches, for x86-64-v3: compiled with -march=x86-64-v3.
#define CAROM_TOLERANCE_NAME tolerance_v3
#define CAROM_TOLERANCE_BATCH_NAME tolerance_batch_v3
#include "tolerance/batch_impl.h"
