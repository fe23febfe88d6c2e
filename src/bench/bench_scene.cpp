#include "bench/bench_scene.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <numeric>

#include <fmt/format.h>

#include "bench/bench_rows.h"
#include "core/error.h"
#include "core/text.h"
#include "runs/pilot.h"
#include "runs/play_run.h"

namespace mote {

namespace {

/// The reference's runs have seeds of their own, so that errors are independent of it.
constexpr uint32_t reference_seed = 0x50000000u;
/// Enough to know the reference's noise in every pixel.
constexpr int reference_runs = 8;
constexpr int fewest_runs = 2;
/// Of a time budget; the rest is for the reference image.
constexpr double runs_share = 0.5;
constexpr double least_reference_share = 0.2;

double now()
{
    const auto time = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double>(time).count();
}

double cpu_now()
{
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// The benchmark of one scene while it runs.
struct Bench {
    const SceneDescription& scene;
    const BenchParams& params;
    const BenchHooks& hooks;
    int frame = 0;
    std::vector<BenchMode> modes;
    std::vector<FramePlan> plans;  ///< of each mode
    std::vector<Method> methods;
    std::vector<Pilot> pilots;
    std::vector<int> samples;  ///< of each method
    std::vector<std::string> left_out;
    double wall_per_cpu = 1.0;  ///< clock time over CPU time, on this machine now
    PixelStats reference;

    void say(const std::string& line) const
    {
        if (hooks.say) hooks.say(line);
    }
    /// The frame compared, alone.
    [[nodiscard]] FramePlan last_frame() const { return {{plans.front().frames.back()}, 1}; }
};

/// CPU time of one run of every method in one mode, by the short runs.
double round_seconds(const Bench& bench, size_t mode)
{
    const FramePlan& plan = bench.plans[mode];
    const std::vector<int> factors = curve_factors(plan);
    const int factor = std::accumulate(factors.begin(), factors.end(), 0);
    double seconds = 0.0;
    for (size_t i = 0; i < bench.methods.size(); ++i) {
        const int frames = frames_rendered(plan, bench.methods[i].keeps_history);
        const double builds =
            bench.modes[mode] == BenchMode::Moving ? frames : static_cast<double>(factors.size());
        seconds += frames * factor * bench.samples[i] * bench.pilots[i].sample_seconds +
                   builds * bench.pilots[i].cache_seconds;
    }
    return seconds;
}

RowInputs row_inputs(const Bench& bench, size_t method, const FramePlan& plan)
{
    return {bench.methods[method], bench.samples[method], plan,
            bench.scene.render,    bench.reference,       bench.hooks.stop};
}

/// Renders the reference image, for about `seconds` of CPU time.
ReferenceInfo render_reference(Bench& bench, double seconds)
{
    const FramePlan last = bench.last_frame();
    Method method;
    Pilot pilot;
    const int best = best_reference_row(bench.methods, bench.pilots);
    if (bench.params.reference.empty() && best >= 0) {
        method = bench.methods[static_cast<size_t>(best)];
        pilot = bench.pilots[static_cast<size_t>(best)];
    } else {
        const bool named = !bench.params.reference.empty();
        method = find_method(named ? bench.params.reference : all_methods().front().name);
        pilot = run_pilot(last, method, bench.scene.render, bench.hooks.stop);
    }
    const double samples = seconds / (reference_runs * pilot.sample_seconds);
    ReferenceInfo info;
    info.method = method.name;
    info.runs = reference_runs;
    info.samples = static_cast<int>(std::clamp(std::round(samples), 1.0, 1e7));
    bench.say(fmt::format(
        "reference image: {}, {} x {} samples per pixel, about {:.0f} s of CPU time", method.name,
        info.runs, info.samples, info.runs * info.samples * pilot.sample_seconds));
    for (uint32_t k = 0; k < reference_runs; ++k) {
        const RenderDescription render = settings_of(bench.scene.render, method, info.samples,
                                                     reference_seed + bench.params.seed + k);
        add_run(bench.reference,
                play_run(last, method.keeps_history, render, bench.hooks.stop).image);
    }
    info.mean = bench.reference.image_means.mean;
    if (!(std::abs(info.mean) > 0.0)) {
        throw Error(ExitCode::Input, fmt::format("{}: the picture is black: nothing to measure",
                                                 printable(bench.scene.path, 1000)));
    }
    info.relative_error = bench.reference.image_means.standard_error() / std::abs(info.mean);
    info.noise = reference_noise(bench.reference);
    return info;
}

/// Runs all methods in turns; fewer rounds than asked for once `seconds` have passed (0: no limit).
ModeResult run_mode(const Bench& bench, size_t mode_index, int rounds, double seconds)
{
    const BenchMode mode = bench.modes[mode_index];
    const FramePlan& plan = bench.plans[mode_index];
    std::vector<RowRuns> rows;
    for (size_t i = 0; i < bench.methods.size(); ++i) {
        rows.push_back(start_row(row_inputs(bench, i, plan)));
    }
    const double start = now();
    for (int round = 0; round < rounds; ++round) {
        const double elapsed = now() - start;
        if (seconds > 0.0 && round >= fewest_runs && elapsed * (round + 1) > seconds * round) break;
        bench.say(fmt::format("{}: run {} of {}", mode_name(mode), round + 1, rounds));
        const uint32_t seed = bench.params.seed + static_cast<uint32_t>(round);
        for (size_t i = 0; i < rows.size(); ++i) {
            add_run(row_inputs(bench, i, plan), seed, rows[i]);
        }
    }
    ModeResult result;
    result.mode = mode;
    for (size_t i = 0; i < rows.size(); ++i) {
        result.rows.push_back(finish_row(row_inputs(bench, i, plan), std::move(rows[i])));
    }
    rate_rows(result.rows);
    return result;
}

/// Without a list of methods, leaves out those that cannot win.
void leave_out_hopeless(Bench& bench)
{
    if (!bench.params.methods.empty()) return;
    const std::vector<bool> worth = worth_measuring(bench.methods, bench.pilots);
    std::vector<Method> methods;
    std::vector<Pilot> pilots;
    for (size_t i = 0; i < worth.size(); ++i) {
        if (!worth[i]) {
            bench.left_out.push_back(bench.methods[i].name);
            continue;
        }
        methods.push_back(bench.methods[i]);
        pilots.push_back(bench.pilots[i]);
    }
    bench.methods = std::move(methods);
    bench.pilots = std::move(pilots);
}

/// Makes the frames, and chooses methods and their samples from short runs.
void prepare(Bench& bench)
{
    SceneCache cache;
    for (const BenchMode mode : bench.modes) {
        bench.plans.push_back(
            plan_frames(bench.scene, mode, bench.frame, bench.params.frames, cache));
    }
    const FramePlan plan = bench.last_frame();
    bench.methods = choose_methods(bench.params.methods, traits_of(plan.frames.back()));
    for (Method& method : bench.methods) {
        if (method.samples_per_frame > 0) method.samples_per_frame = bench.params.passes;
    }
    bench.say(fmt::format("short runs of {} methods", bench.methods.size()));
    const double start = now();
    const double cpu_start = cpu_now();
    for (const Method& method : bench.methods) {
        bench.pilots.push_back(run_pilot(plan, method, bench.scene.render, bench.hooks.stop));
    }
    bench.wall_per_cpu = (now() - start) / std::max(cpu_now() - cpu_start, 1e-6);
    leave_out_hopeless(bench);
    bench.samples = equal_time_samples(bench.methods, bench.pilots, bench.params.samples);
}

}  // namespace

SceneResult bench_scene(const SceneDescription& scene, const BenchParams& params,
                        const BenchHooks& hooks)
{
    const double start = now();
    Bench bench{scene, params, hooks, 0, {}, {}, {}, {}, {}, {}, 1.0, {}};
    bench.frame = params.frame.value_or(scene.first_frame + params.frames.warm_up);
    bench.modes = choose_modes(params.modes, scene);
    prepare(bench);

    double round = 0.0;
    for (size_t i = 0; i < bench.plans.size(); ++i) round += round_seconds(bench, i);
    const double left = std::max(params.time_budget - (now() - start), 0.0);
    int rounds = params.runs;
    double reference_seconds = params.runs * round;
    if (params.time_budget > 0.0) {
        const double round_wall = round * bench.wall_per_cpu;
        const double fitting = std::floor(runs_share * left / round_wall);
        rounds = static_cast<int>(std::clamp(fitting, double{fewest_runs}, double(params.runs)));
        // Where the fewest runs take more than their share, the reference image has the rest.
        reference_seconds =
            std::max(left - rounds * round_wall, least_reference_share * left) / bench.wall_per_cpu;
    }
    if (params.reference_time > 0.0) reference_seconds = params.reference_time;

    SceneResult result;
    result.path = scene.path;
    result.name = scene.name;
    result.hash = scene.hash;
    result.width = scene.render.width;
    result.height = scene.render.height;
    result.frame = bench.frame;
    result.seed = params.seed;
    result.left_out = bench.left_out;
    result.reference = render_reference(bench, reference_seconds);
    const double share = runs_share * left / static_cast<double>(bench.modes.size());
    for (size_t i = 0; i < bench.modes.size(); ++i) {
        result.modes.push_back(run_mode(bench, i, rounds, share));
    }
    return result;
}

}  // namespace mote
