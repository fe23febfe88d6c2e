#include <filesystem>
#include <iterator>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "app/bench_options.h"
#include "app/commands.h"
#include "app/frame_files.h"
#include "app/signals.h"
#include "app/text_file.h"
#include "bench/report.h"
#include "bench/result_changes.h"
#include "bench/sweep_report.h"
#include "core/error.h"
#include "core/parallel.h"
#include "plots/page.h"
#include "runs/methods.h"
#include "scene/scene_io.h"
#include "volumes/walk_isa.h"

namespace mote {

namespace {

constexpr const char* quick_size[] = {"render.width=112", "render.height=63"};

SceneDescription load_bench_scene(const std::string& path, const BenchOptions& options)
{
    std::vector<std::string> overrides;
    if (options.quick) overrides.assign(std::begin(quick_size), std::end(quick_size));
    overrides.insert(overrides.end(), options.overrides.begin(), options.overrides.end());
    overrides.insert(overrides.end(), options.resolution.begin(), options.resolution.end());
    return load_scene(path, overrides);
}

void print_methods()
{
    for (const Method& method : all_methods()) fmt::print("{:<22}{}\n", method.name, method.doc);
}

/// Written after every scene: a long benchmark that is stopped keeps what it has.
void write_results(const BenchOptions& options, const BenchReport& report)
{
    if (!options.json.empty()) write_text_file(options.json, bench_json(report));
    if (!options.csv.empty()) write_text_file(options.csv, bench_csv(report));
    if (!options.html.empty()) write_text_file(options.html, bench_html(report));
    if (options.svg.empty()) return;
    const SceneResult& scene = report.scenes.back();
    for (const ModeResult& mode : scene.modes) {
        const std::string name = fmt::format(
            "{}-{}.svg", std::filesystem::path(scene.path).stem().string(), mode_name(mode.mode));
        write_text_file((std::filesystem::path(options.svg) / name).string(),
                        svg_file(error_plot(scene, mode)));
    }
}

/// Wrong places come to light before anything is measured.
void require_writable(const BenchOptions& options)
{
    for (const std::string* file : {&options.json, &options.csv, &options.html}) {
        if (!file->empty()) require_writable_folder(*file);
    }
    if (options.svg.empty()) return;
    require_writable_folder((std::filesystem::path(options.svg) / "plot.svg").string());
}

void measure(const BenchOptions& options)
{
    const StopSignals signals;
    const BenchParams params = bench_params(options);
    // Wrong names and scenes come to light before anything is measured.
    (void)choose_methods(params.methods, {});
    if (!params.reference.empty()) (void)find_method(params.reference);
    std::vector<SceneDescription> scenes;
    for (const std::string& path : options.inputs) {
        scenes.push_back(load_bench_scene(path, options));
        (void)choose_modes(params.modes, scenes.back());
    }
    require_writable(options);

    const BenchHooks hooks{stop_requested, [](const std::string& line) { spdlog::info(line); }};
    const std::string build =
        fmt::format(MOTE_ARCH " " MOTE_BUILD_TYPE ", ray walk {}", name_of(walk_isa()));
    BenchReport report{MOTE_VERSION, build, options.threads, {}};
    run_with_threads(options.threads, [&] {
        for (const SceneDescription& scene : scenes) {
            report.scenes.push_back(bench_scene(scene, params, hooks));
            fmt::print("{}{}", report.scenes.size() > 1 ? "\n" : "",
                       bench_table(report.scenes.back()));
            std::fflush(stdout);
            write_results(options, report);
        }
    });
    fmt::print("{}", bench_legend());
}

void write_sweeps(const BenchOptions& options, const std::vector<SweepResult>& sweeps)
{
    if (!options.json.empty()) write_text_file(options.json, sweeps_json(sweeps));
    if (!options.csv.empty()) write_text_file(options.csv, sweeps_csv(sweeps));
    if (!options.html.empty()) write_text_file(options.html, sweeps_html(sweeps));
    if (options.svg.empty()) return;
    const std::string name = fmt::format("sweep-{}.svg", sweep_info(sweeps.back().kind).name);
    write_text_file((std::filesystem::path(options.svg) / name).string(),
                    svg_file(sweep_plot(sweeps.back())));
}

void measure_sweeps(const BenchOptions& options)
{
    const StopSignals signals;
    const std::vector<SweepKind> kinds = choose_sweeps(options.sweep);
    SweepParams params;
    if (!options.methods.empty()) params.methods = options.methods;
    params.seconds = options.max_seconds;
    params.most_threads = available_threads();
    (void)choose_methods(params.methods, {});
    if (options.inputs.size() > 1) {
        throw Error(ExitCode::Usage, "--sweep measures one scene, or its own");
    }
    std::optional<SceneDescription> scene;
    if (!options.inputs.empty()) scene = load_bench_scene(options.inputs.front(), options);
    for (const SweepKind kind : kinds) {
        if (!scene || sweep_info(kind).takes_scene) continue;
        throw Error(ExitCode::Usage, fmt::format("--sweep {} has a scene of its own; leave out {}",
                                                 sweep_info(kind).name, options.inputs.front()));
    }
    require_writable(options);
    const SweepHooks hooks{stop_requested, [](const std::string& line) { spdlog::info(line); }};
    std::vector<SweepResult> sweeps;
    for (const SweepKind kind : kinds) {
        sweeps.push_back(run_sweep(kind, scene, params, hooks));
        fmt::print("{}{}", sweeps.size() > 1 ? "\n" : "", sweep_text(sweeps.back()));
        std::fflush(stdout);
        write_sweeps(options, sweeps);
    }
}

void compare_results(const BenchOptions& options)
{
    if (options.inputs.size() != 1) {
        throw Error(ExitCode::Usage, "--against compares two results files: name one before it");
    }
    const auto read = [](const std::string& path) {
        return parse_bench_json(read_text_file(path), path);
    };
    const std::vector<RowChange> changes =
        find_changes(read(options.against), read(options.inputs.front()));
    if (changes.empty()) {
        throw Error(ExitCode::Input,
                    "the files have no scene, size, frame, seed, mode and method in common");
    }
    fmt::print("{}", changes_table(changes));
}

}  // namespace

void run_bench(const BenchOptions& options)
{
    if (options.list) {
        print_methods();
    } else if (!options.against.empty()) {
        compare_results(options);
    } else if (!options.sweep.empty()) {
        measure_sweeps(options);
    } else if (options.inputs.empty()) {
        throw Error(ExitCode::Usage, "no scene to measure\nTry: mote bench --help");
    } else {
        measure(options);
    }
}

}  // namespace mote
