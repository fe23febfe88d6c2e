#include "app/bench_options.h"

#include <cstdio>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/shared_options.h"
#include "core/error.h"
#include "core/text.h"
#include "runs/methods.h"

namespace mote {

namespace {

constexpr int most_frames = 1000;

/// What --quick stands for, where nothing else is said.
constexpr int quick_runs = 4;
constexpr FrameCounts quick_frames{4, 4};
constexpr double quick_seconds = 30.0;

FrameCounts parse_frame_counts(const std::string& text)
{
    FrameCounts counts;
    int used = 0;
    if (std::sscanf(text.c_str(), "%4d+%4d%n", &counts.warm_up, &counts.still, &used) != 2 ||
        static_cast<size_t>(used) != text.size() || counts.warm_up < 0 || counts.still < 1 ||
        counts.warm_up > most_frames || counts.still > most_frames) {
        throw Error(ExitCode::Usage,
                    fmt::format("--frames \"{}\" is not WARM-UP+STILL, e.g. 8+8, at most {} each",
                                printable(text), most_frames));
    }
    return counts;
}

std::string known_methods()
{
    std::string names;
    for (const Method& method : all_methods()) names += (names.empty() ? "" : ", ") + method.name;
    return names;
}

}  // namespace

void bind_bench(CLI::App& app, BenchOptions& o)
{
    app.add_option("scenes", o.inputs, "Scene files; with --against, a results file")
        ->type_name("SCENE");
    app.add_option("--methods", o.methods,
                   "Rows of the table, by comma; path* is all that begin so. Default: those that "
                   "make sense for the scene's lights, without path tracers far behind. Known: " +
                       known_methods())
        ->type_name("LIST");
    app.add_option(
           "--modes", o.modes,
           "still: one frame alone, of many samples, with its error at fewer; static: one frame "
           "after "
           "warm-up frames; accumulated: the mean of several; camera: static, but the camera "
           "travels 1 degree a frame around its focus; moving: the animation. Default: moving if "
           "anything moves, else still,static")
        ->type_name("LIST");
    app.add_option("--frames", o.frames,
                   "Frames before those compared (but for still); and how often still takes the "
                   "samples of a frame, and accumulated frames. Default: 8+8")
        ->type_name("W+N");
    app.add_option("--frame", o.frame,
                   "The frame compared. Default: the scene's first after the warm-up")
        ->check(CLI::Range(-1'000'000, 1'000'000))
        ->type_name("N");
    app.add_option("--runs", o.runs,
                   "Independent runs per method: own seeds, empty history. Default: 8")
        ->check(CLI::Range(2, 10'000))
        ->type_name("K");
    app.add_option("--samples", o.samples,
                   "Samples per pixel and frame, of the path tracer. Default: as many "
                   "as make all take the same time")
        ->check(CLI::Range(1, 1'000'000))
        ->type_name("N");
    app.add_option("--passes", o.passes, "Passes per frame of restir")
        ->check(CLI::Range(1, 1'000'000))
        ->capture_default_str()
        ->type_name("N");
    app.add_option("--time-budget", o.time_budget,
                   "About how long a scene may take [s]: fewer runs, a shorter reference")
        ->check(CLI::Range(0.1, 1e6))
        ->type_name("S");
    app.add_option("--reference", o.reference,
                   "Method of the reference image. Default: the best path tracer")
        ->type_name("METHOD");
    app.add_option("--reference-time", o.reference_time,
                   "CPU time of the reference image [s]. Default: that of all runs together")
        ->check(CLI::Range(1e-6, 1e6))
        ->type_name("S");
    app.add_option("--seed", o.seed, "Seed of the first run")
        ->check(CLI::Range(0, 1'000'000'000))
        ->capture_default_str()
        ->type_name("N");
    app.add_option("--threads", o.threads, "Threads; 1 makes CPU times comparable")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str()
        ->type_name("N");
    bind_resolution(app, o.resolution);
    bind_overrides(app, o.overrides);
    app.add_flag("--quick", o.quick,
                 "Small and short, for a look before and after a change: 112x63, 4 runs, 4+4 "
                 "frames, within a minute per scene");
    app.add_flag("--list", o.list, "Print the methods and what they are");
    app.add_option("--json", o.json, "Write every run of every method to this file")
        ->type_name("FILE");
    app.add_option("--csv", o.csv, "Write the tables to this file")->type_name("FILE");
    app.add_option("--html", o.html, "Write a page with plots and tables")->type_name("FILE");
    app.add_option("--svg", o.svg,
                   "Write a plot of error against time per scene and mode into this folder")
        ->type_name("FOLDER");
    app.add_option("--sweep", o.sweep,
                   "What frames cost as something grows, by comma: threads, resolution, voxels, "
                   "particles, lights, empty, or all. On a scene of its own, or (threads, "
                   "resolution, empty) on SCENE. --methods are those measured; default: "
                   "path,restir-off")
        ->type_name("LIST");
    app.add_option("--max-seconds", o.max_seconds,
                   "Time for each sweep [s]; sizes that are not expected to fit are left out")
        ->check(CLI::Range(0.1, 1e6))
        ->capture_default_str()
        ->type_name("S");
    app.add_option("--against", o.against,
                   "Compare the results file SCENE with this one: what differs by more than noise?")
        ->type_name("FILE");
    bind_log(app, o.log);
    app.footer(
        "Examples:\n"
        "  mote bench scenes/bench_plume_g3.toml --json before.json\n"
        "  mote bench scenes/bench_1000_lights.toml --methods 'path-tree*' --quick\n"
        "  mote bench after.json --against before.json\n"
        "  mote bench --sweep lights,particles --html sweeps.html\n");
}

BenchParams bench_params(const BenchOptions& options)
{
    BenchParams params;
    params.modes = options.modes;
    params.methods = options.methods;
    params.reference = options.reference;
    params.frame = options.frame;
    params.samples = options.samples;
    params.passes = options.passes;
    params.time_budget = options.time_budget;
    params.reference_time = options.reference_time;
    params.seed = static_cast<uint32_t>(options.seed);
    if (options.quick) {
        params.runs = quick_runs;
        params.frames = quick_frames;
        if (params.time_budget == 0.0) params.time_budget = quick_seconds;
    }
    if (options.frames) params.frames = parse_frame_counts(*options.frames);
    params.runs = options.runs.value_or(params.runs);
    return params;
}

}  // namespace mote
