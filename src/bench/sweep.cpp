#include "bench/sweep.h"

#include <chrono>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "bench/bench_rows.h"
#include "core/parallel.h"
#include "scene/prepare.h"

namespace mote {

namespace {

/// Short frames are repeated: the least of several times is that of the undisturbed one.
constexpr double repeat_seconds = 0.2;
constexpr int most_repeats = 5;
constexpr uint32_t seed = 1;
/// The frame shown: particles have spread by then.
constexpr int frames_in = 24;

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start)
{
    return std::chrono::duration<double>(Clock::now() - start).count();
}

SweepRow measure_row(const FramePlan& plan, const Method& method, const RenderDescription& render,
                     bool (*stop)(), MemoryUse& memory)
{
    SweepRow row;
    row.method = method.name;
    double spent = 0.0;
    for (int k = 0; k < most_repeats && (k == 0 || spent < repeat_seconds); ++k) {
        const PlayedRun run =
            play_run(plan, method.keeps_history, settings_of(render, method, 1, seed), stop);
        const double render_seconds = run.cpu_seconds - run.cache_cpu_seconds;
        const auto least = [&](double& kept, double value) {
            kept = k == 0 ? value : std::min(kept, value);
        };
        least(row.cache_seconds, run.cache_cpu_seconds);
        least(row.render_seconds, render_seconds);
        least(row.wall_seconds, run.wall_seconds);
        row.work = run.work;
        memory = run.memory;
        spent += run.wall_seconds;
    }
    return row;
}

}  // namespace

SweepPoint measure_size(const SweepSize& size, const std::vector<Method>& methods, bool (*stop)())
{
    SweepPoint point;
    point.x = size.x;
    point.width = size.scene.render.width;
    point.height = size.scene.render.height;
    run_with_threads(size.threads, [&] {
        SceneCache cache;
        PrepareStats ignored;
        const double start = process_cpu_seconds();
        FramePlan plan;
        plan.frames.push_back(prepare_frame(size.scene, size.scene.first_frame + frames_in,
                                            {false, true}, cache, ignored));
        point.prepare_seconds = process_cpu_seconds() - start;
        for (const Method& method : methods) {
            point.rows.push_back(measure_row(plan, method, size.scene.render, stop, point.memory));
        }
    });
    return point;
}

SweepResult run_sweep(SweepKind kind, const std::optional<SceneDescription>& scene,
                      const SweepParams& params, const SweepHooks& hooks)
{
    SweepResult sweep;
    sweep.kind = kind;
    sweep.scene = scene ? scene->path : "built-in";
    const std::vector<Method> methods = choose_methods(params.methods, {});
    const Clock::time_point start = Clock::now();
    double growth = sweep_info(kind).growth;
    double last = 0.0;
    for (const SweepSize& size : sweep_sizes(kind, params.most_threads, scene)) {
        const bool fits = seconds_since(start) + last * growth <= params.seconds;
        if (!sweep.left_out.empty() || (!sweep.points.empty() && !fits)) {
            sweep.left_out.push_back(size.x);
            continue;
        }
        if (hooks.say) hooks.say(fmt::format("sweep {}: {:g}", sweep_info(kind).name, size.x));
        const Clock::time_point point_start = Clock::now();
        sweep.points.push_back(measure_size(size, methods, hooks.stop));
        const double seconds = seconds_since(point_start);
        if (last > 0.0) growth = std::max(growth, seconds / last);
        last = seconds;
    }
    return sweep;
}

double sweep_slope(const SweepResult& sweep, size_t row)
{
    std::vector<CurvePoint> points;
    for (const SweepPoint& point : sweep.points) {
        points.push_back({1, point.x, 0.0, 0.0, point.rows[row].render_seconds});
    }
    return log_slope(points);
}

}  // namespace mote
