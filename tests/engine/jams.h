// The tests of tests/data/engine/jams.toml.
#pragma once

namespace carom::test {

/// Adds a test for each row, before all tests run.
void register_jams();

}  // namespace carom::test
