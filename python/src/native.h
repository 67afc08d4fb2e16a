// Shared by the parts of the extension module. The Python sources in python/carom are the public interface;
// they check and shape the flat arrays that the module accepts.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "carom/engine/record.h"
#include "carom/engine/scene.h"
#include "carom/kernel/isa.h"

namespace carom::python {

namespace nb = nanobind;

/// A valid scene, and the text that it was read from.
struct NativeScene {
    std::shared_ptr<const Scene> scene;
    std::string source;
};

struct NativeRecord {
    std::shared_ptr<const Record> record;
    std::shared_ptr<const Scene> scene;  ///< that was played; null for a record from a file
};

/// A contiguous array of the caller, to read or to fill.
template <class T>
using Flat = nb::ndarray<T, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

/// The names of an enumeration in the order of its values.
template <class E>
std::vector<std::string> names_in_files() {
    const auto names = names_of(E());
    return {names.begin(), names.end()};
}

/// The scene that was played, or `other`. @throws nb::value_error if there is none, or one with other balls
const Scene& scene_of(const NativeRecord& record, const NativeScene* other);
/// A scene built in code, with a cue as the section of a file, or "". @throws SceneError
NativeScene with_cue(const std::string& section, Scene scene);

/// The instruction set that CAROM_ISA names, else the fastest one for every kernel. @throws nb::value_error
kernel::Isa chosen_isa();

/// The smaller of two limits; empty if there is none.
std::optional<std::int64_t> fewer(std::optional<std::int64_t> a, std::optional<std::int64_t> b);

/// Lets Ctrl-C end a long computation without the GIL. The thread that made the watch checks for signals some
/// 20 times a second.
class SignalWatch {
  public:
    SignalWatch();
    /// Whether a Python signal handler has raised an exception, which is then set. Any thread may call it.
    bool stopped();

  private:
    std::thread::id caller_;
    double next_;
    bool raised_ = false;
};

void add_scenes(nb::module_& m);
void add_records(nb::module_& m);
void add_shots(nb::module_& m);
void add_batches(nb::module_& m);
void add_measures(nb::module_& m);
void add_impacts(nb::module_& m);
void add_frames(nb::module_& m);
void add_games(nb::module_& m);
void add_arrays(nb::module_& m);
void add_judged(nb::module_& m);
void add_games_rules(nb::module_& m);
void add_derivatives(nb::module_& m);

}  // namespace carom::python
