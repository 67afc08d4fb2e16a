// The contents of the C interface's opaque handles.
#pragma once

#include "carom/engine/batch.h"
#include "carom/engine/record.h"
#include "carom/interface/shape.h"

struct carom_scene {
    carom::Scene scene;
};

struct carom_record {
    carom::Record record;
    carom::Scene scene;  // that was played
};

struct carom_value {
    carom::interface::Value value;
};

struct carom_batch {
    carom::Batch batch;
};

namespace carom::c {

/// The part of a value at a path: "options[0].state.turn"; "" is the whole. @throws BadArgument
const interface::Value& part_at(const carom_value* value, const char* path);

/// @param json  null: an object without keys @throws BadArgument with `name`
interface::Value json_of(const char* json, const char* name);

}  // namespace carom::c
