#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runs/methods.h"
#include "runs/work.h"
#include "scene/description.h"

namespace mote {

/// What grows from one size to the next.
enum class SweepKind { Threads, Resolution, Voxels, Particles, Lights, Empty };

struct SweepInfo {
    SweepKind kind;
    const char* name;     ///< on the command line and in the results
    const char* x_label;  ///< what SweepPoint::x counts
    const char* column;   ///< the same in a word or two
    const char* doc;
    double growth;     ///< of the time, expected between the first two sizes
    bool takes_scene;  ///< a scene of the user's can be measured; else only the built-in one
};

[[nodiscard]] std::span<const SweepInfo> sweep_table();
[[nodiscard]] const SweepInfo& sweep_info(SweepKind kind);

/// The sweeps named in a list by comma, or all. Throws Error(Usage) for an unknown name.
[[nodiscard]] std::vector<SweepKind> choose_sweeps(const std::string& list);

/// One size of a sweep.
struct SweepSize {
    double x = 0.0;
    int threads = 1;
    SceneDescription scene;
};

/// The sizes, smallest first: threads 1 to `most_threads`; 80x45 to 1280x720 pixels; 128^3 to
/// 1024^3 voxels around a cloud of particles; 10^3 to 10^7 particles; 1 to 10^6 lamps; smoke that
/// covers all of the image to hardly anything. `scene`: the user's, of the sweeps that take one.
[[nodiscard]] std::vector<SweepSize> sweep_sizes(SweepKind kind, int most_threads,
                                                 const std::optional<SceneDescription>& scene);

/// A method at one size. Times are of one frame of one sample per pixel, the least of some runs.
struct SweepRow {
    std::string method;
    double cache_seconds = 0.0;   ///< CPU
    double render_seconds = 0.0;  ///< CPU, caches apart
    double wall_seconds = 0.0;    ///< by the clock, caches included
    WorkCounts work;              ///< of the frame
};

struct SweepPoint {
    double x = 0.0;
    int width = 0;
    int height = 0;
    double prepare_seconds = 0.0;  ///< CPU: particles, grids, lights
    MemoryUse memory;              ///< of the last method
    std::vector<SweepRow> rows;
};

struct SweepResult {
    SweepKind kind = SweepKind::Threads;
    std::string scene;               ///< path, or "built-in"
    std::vector<SweepPoint> points;  ///< smallest first
    std::vector<double> left_out;    ///< sizes that would have taken too long
};

struct SweepParams {
    std::string methods = "path,restir-off";
    double seconds = 60.0;  ///< for the sweep; sizes that are not expected to fit are left out
    int most_threads = 1;
};

struct SweepHooks {
    bool (*stop)() = nullptr;                     ///< ends it with Error(Interrupted)
    std::function<void(const std::string&)> say;  ///< progress, a line each
};

/// Prepares a size's scene and renders it by each method.
[[nodiscard]] SweepPoint measure_size(const SweepSize& size, const std::vector<Method>& methods,
                                      bool (*stop)());

/// Runs a sweep. Sizes run on one thread, those of Threads on as many as they say.
[[nodiscard]] SweepResult run_sweep(SweepKind kind, const std::optional<SceneDescription>& scene,
                                    const SweepParams& params, const SweepHooks& hooks);

/// Power of x with which a method's time without caches grows, fitted over log and log; NaN for
/// fewer than two points.
[[nodiscard]] double sweep_slope(const SweepResult& sweep, size_t row);

}  // namespace mote
