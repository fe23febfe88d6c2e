#pragma once

#include <string>
#include <vector>

#include "bench/bench_scene.h"

namespace mote {

/// What a results file holds.
struct BenchReport {
    std::string version;  ///< of mote
    std::string build;    ///< instruction sets and build type
    int threads = 1;
    std::vector<SceneResult> scenes;
};

/// A scene's results as text: the reference image, then one table per mode.
[[nodiscard]] std::string bench_table(const SceneResult& scene);

/// What the columns mean, a few lines.
[[nodiscard]] std::string bench_legend();

/// Every run of every method. Figures that do not exist (NaN) are null.
[[nodiscard]] std::string bench_json(const BenchReport& report);

/// A line per scene, mode and method, with a line of column names.
[[nodiscard]] std::string bench_csv(const BenchReport& report);

/// Error against time of a mode's rows, log over log, as an <svg> element; dashed: known to be
/// biased.
[[nodiscard]] std::string error_plot(const SceneResult& scene, const ModeResult& mode);

/// A self-contained page: plots of every scene and mode, and the tables.
[[nodiscard]] std::string bench_html(const BenchReport& report);

/// Reads what bench_json wrote, names, runs and settings; figures are not read. `path` is for
/// messages. Throws Error(Input) if it is something else.
[[nodiscard]] BenchReport parse_bench_json(const std::string& text, const std::string& path);

}  // namespace mote
