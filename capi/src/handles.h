// What the opaque handles of the C interface hold.
#pragma once

#include "carom/engine/batch.h"
#include "carom/engine/record.h"

struct carom_scene {
    carom::Scene scene;
};

struct carom_record {
    carom::Record record;
    carom::Scene scene;  // that was played
};

struct carom_batch {
    carom::Batch batch;
};
