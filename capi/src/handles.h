// The contents of the C interface's opaque handles.
#pragma once

#include <string>
#include <vector>

#include "carom/engine/batch.h"
#include "carom/engine/record.h"
#include "carom/games/player.h"
#include "carom/games/rules.h"

struct carom_scene {
    carom::Scene scene;
};

struct carom_record {
    carom::Record record;
    carom::Scene scene;  // that was played
};

struct carom_verdict {
    carom::games::Verdict verdict;
    std::string record;  // hash of the record that was judged
};

struct carom_advice {
    std::vector<carom::games::Advice> shots;
    std::vector<std::string> words;
};

struct carom_batch {
    carom::Batch batch;
};
