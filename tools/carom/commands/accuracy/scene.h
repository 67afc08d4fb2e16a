// carom accuracy SCENE: the cost of each accuracy setting for a shot, and which setting the shot needs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/options.h"
#include "carom/engine/plan.h"
#include "carom/engine/record.h"
#include "report/plot.h"
#include "report/table.h"

namespace carom::tools {

struct AccuracySceneArgs {
    std::string scene;
    /// Allowed final error [m].
    double target = 1e-3;
    /// N of the march.
    std::vector<int> march = {100, 1000, 10000, 100000};
    std::vector<double> tolerances = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12};
    /// Interleaved rounds.
    int repeat = 5;
    bool json = false;
    /// File names; empty: not written.
    std::string csv, plot;
};

/// The contacts of a shot: all of them in order, the first ball hit, and which pocket each ball fell into.
struct ShotContacts {
    std::vector<std::string> contacts;
    std::string first_contact;  ///< the ball that the struck ball hits first, or ""
    std::vector<int> pockets;   ///< per ball, -1: on the table
};
ShotContacts contacts_of(const Scene& scene, const Record& record);

/// Distances between the final positions of the same ball in two runs [m].
struct FinalError {
    double largest = 0.0, median = 0.0;
};
FinalError final_error(const std::vector<Vec2>& a, const std::vector<Vec2>& b);
std::vector<Vec2> final_positions(const Record& record);

/// One setting of one shot. Times are the thread's processor time for the whole simulation [ns].
struct SceneAccuracyRow {
    std::string method;   ///< march, march published, tolerance
    std::string setting;  ///< "N=1000", "1e-06"
    /// Another simulator: it has no kernel, and the order of its contacts is not exact.
    bool other_simulator = false;
    double value = 0.0;
    double ns_min = 0.0, ns_median = 0.0, ns_max = 0.0;
    double kernel_share = 0.0, cluster_share = 0.0;  ///< of a profiled run
    FinalError error;                                ///< relative to the converged run
    /// [m] The same if only clusters have this setting.
    double cluster_error = 0.0;
    bool order_same = false, first_same = false, pocketed_same = false;
    std::string failed;  ///< why the run failed, or ""
};

struct SceneAccuracy {
    double target = 0.0;
    double gain = 0.0;       ///< final displacement over initial displacement, for a twin moved by `twin`
    double twin = 0.0;       ///< [m]
    bool clusters = false;   ///< three or more balls meet at once
    double agreement = 0.0;  ///< largest final distance between the two converged runs [m]
    bool outcome_agrees = false;  ///< of the two converged runs
    /// both agree far more closely than the target, so differences may be called errors
    bool converged = false;
    /// By gain, and met here by it and every tighter one; empty if double precision does not allow it.
    std::optional<double> recommended;
    std::optional<double> loosest;            ///< measured here: it and every tighter one met the target
    std::size_t contacts = 0, ball_hits = 0;  ///< of the converged run; hits: of two balls or a cluster
    std::string sentence;
    std::vector<SceneAccuracyRow> rows;
};

/// The gain, from twins of the plan whose struck ball starts a twin_step() to the side and ahead; the larger
/// of the two.
double gain_of(const Plan& plan, const Record& record);
/// [m] Clusters are smooth only to their own error, so their twins must differ by more.
double twin_step(const Record& record);
/// Whether three or more balls meet at once.
bool has_clusters(const Record& record);

/// The loosest power of ten that keeps gain x tolerance x kFlight within the target; empty if that is below
/// the tightest tolerance, where double precision ends.
std::optional<double> deserved_tolerance(double gain, double target);
/// [m] A relative speed error t after an impact becomes a position error of t times the distance to the next
/// impact, which is at most about this.
inline constexpr double kFlight = 1.0;

/// A plan of the same scene with another setting.
Plan with_tolerance(const Scene& scene, double tolerance);
Plan with_substeps(const Scene& scene, int substeps, March march = March::kSummed);
/// Solves every impact of two balls by power series in extended precision, and clusters by short steps
/// between located events, which share no code with the kernels: the second converged method.
Plan with_reference(const Scene& scene);

SceneAccuracy measure_scene_accuracy(const Scene& scene, const AccuracySceneArgs& args);
/// Minimum, median and maximum of a row's times.
void set_times(SceneAccuracyRow& row, const std::vector<double>& samples_ns);

/// The options that the program and the laboratory share, and their checks before any work.
void add_accuracy_options(Options& command, AccuracySceneArgs& args);
/// @throws UsageError, SceneError
Plan plan_for_accuracy(const AccuracySceneArgs& args);

/// One row per setting.
Table scene_accuracy_table(const SceneAccuracy& result);
/// Error against time, with the recommended tolerance.
Plot scene_accuracy_plot(const SceneAccuracy& result, const std::string& scene);
/// The lines above the table.
std::vector<std::string> scene_accuracy_notes(const SceneAccuracy& result, const std::string& scene);
std::string scene_accuracy_text(const SceneAccuracy& result, const std::string& scene);
std::string scene_accuracy_json(const SceneAccuracy& result);

}  // namespace carom::tools
