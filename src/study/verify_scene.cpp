#include "study/verify_scene.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "image/color_of.h"
#include "runs/methods.h"
#include "runs/pilot.h"
#include "runs/play_frames.h"

namespace mote {

namespace {

constexpr int default_warm_up = 8;
constexpr double most_samples = 4096.0;
/// Of runs whose passes are independent anyway: shorter ones would pay more for keeping the books.
constexpr double run_seconds = 0.2;
constexpr double most_passes = 64.0;
/// Of the time for the study, at most, for sequences.
constexpr double temporal_share = 0.1;

const std::vector<std::string> part_names{"volume_direct", "volume_indirect", "volume_emission",
                                          "direct",        "indirect",        "emission",
                                          "background",    "transmittance"};

double seconds_since(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The scene's own settings under the restir estimator.
Method own_method()
{
    Method method;
    method.name = "restir";
    method.is_reference = false;
    method.keeps_history = true;
    method.samples_per_frame = 1;
    method.edit = [](RenderDescription& render) { render.estimator = EstimatorKind::Restir; };
    return method;
}

/// A study while it is set up.
struct Setup {
    const SceneDescription& scene;
    const VerifyParams& params;
    const VerifyHooks& hooks;
    FramePlan plan;
    FramePlan last_frame;
    PlanCaches caches;
    std::vector<std::string> parts;  ///< layers that show anything
    Method tested;
    Method reference;
    int passes = 1;               ///< of the tested method, per frame
    int64_t truncated_paths = 0;  ///< so far

    void say(const std::string& line) const
    {
        if (hooks.say) hooks.say(line);
    }
};

RenderDescription settings_of(const Setup& setup, const Method& method, int samples)
{
    RenderDescription render = setup.scene.render;
    method.edit(render);
    render.samples = samples;
    return render;
}

/// What no statistics are needed for.
void require_sound(const FrameStats& stats, uint32_t seed)
{
    if (stats.dropped_non_finite > 0) {
        throw Error(ExitCode::BiasFound, fmt::format("seed {}: {} samples were NaN or infinite",
                                                     seed, stats.dropped_non_finite));
    }
    if (stats.tracking.majorant_violations > 0) {
        throw Error(ExitCode::BiasFound,
                    fmt::format("seed {}: {} densities were above their majorants", seed,
                                stats.tracking.majorant_violations));
    }
}

/// Runs of a method, each of which is the plan's last frame from empty history.
RunSource source_of(Setup& setup, const Method& method, int samples)
{
    return [&setup, render = settings_of(setup, method, samples),
            keeps_history = method.keeps_history](uint32_t seed) {
        RenderDescription seeded = render;
        seeded.seed = seed;
        LayeredImage last;
        play_frames(setup.plan, keeps_history, seeded, float_output(setup.parts), setup.hooks.stop,
                    render.estimator == EstimatorKind::Restir ? &setup.caches : nullptr,
                    [&](size_t, const LayeredImage& image, const FrameStats& stats) {
                        last = image;
                        setup.truncated_paths += stats.truncated_paths;
                        require_sound(stats, seed);
                    });
        return last;
    };
}

/// The path tracer of least variance times time. With lamps nearby only those with equiangular
/// distances: the others' variance is infinite, and t-tests want finite ones.
Method choose_reference(const Setup& setup)
{
    if (!setup.params.reference.empty()) return find_method(setup.params.reference);
    const SceneTraits traits = traits_of(setup.last_frame.frames.back());
    std::vector<Method> candidates;
    std::vector<Pilot> pilots;
    for (const Method& method : choose_methods("path*", traits)) {
        const bool is_equiangular = method.name.find("-equi") != std::string::npos;
        if (!method.is_worthwhile(traits) || is_equiangular != traits.local_lights) continue;
        candidates.push_back(method);
        pilots.push_back(run_pilot(setup.last_frame, method, setup.scene.render, setup.hooks.stop));
    }
    const int best = best_reference_row(candidates, pilots);
    return best < 0 ? find_method("path") : candidates[static_cast<size_t>(best)];
}

/// Time of a run, the second of two, and the images of both.
struct ShortRuns {
    LayeredImage images[2];
    double seconds = 0.0;
    double variance = 0.0;  ///< of a pixel, without the worst ones
};

ShortRuns short_runs(const RunSource& source, uint32_t seed)
{
    ShortRuns runs;
    PixelStats stats;
    for (uint32_t k = 0; k < 2; ++k) {
        const auto start = std::chrono::steady_clock::now();
        runs.images[k] = source(seed + k);
        runs.seconds = std::max(seconds_since(start), 1e-6);
        Buffer2D<Spectrum> color = color_of(runs.images[k]);
        replace_non_finite(color);
        add_run(stats, color);
    }
    runs.variance = trimmed_mean_variance(stats, 1e-3);
    return runs;
}

/// Whether the frames before change the last one at all, by a run with and one without them.
bool history_matters(Setup& setup, const Method& method)
{
    if (!method.keeps_history || setup.plan.frames.size() < 2) return false;
    Method without = method;
    without.keeps_history = false;
    const int passes = std::max(setup.params.passes, 1);
    const LayeredImage a = source_of(setup, method, passes)(short_run_seed);
    const LayeredImage b = source_of(setup, without, passes)(short_run_seed);
    return !std::equal(a.channels.begin(), a.channels.end(), b.channels.begin(),
                       [](const Channel& x, const Channel& y) {
                           return std::equal(x.data.begin(), x.data.end(), y.data.begin());
                       });
}

/// Leaves out the layers in which nothing is seen.
void choose_parts(Setup& setup, std::initializer_list<const ShortRuns*> all_runs)
{
    std::vector<std::string> parts;
    const auto shows = [](const LayeredImage& image, const std::string& part) {
        return std::any_of(image.channels.begin(), image.channels.end(), [&](const Channel& c) {
            return c.name.rfind(part + ".", 0) == 0 &&
                   std::any_of(c.data.begin(), c.data.end(), [](float v) { return v != 0.0f; });
        });
    };
    for (const std::string& part : part_names) {
        bool is_seen = false;
        for (const ShortRuns* runs : all_runs) {
            is_seen = is_seen || shows(runs->images[0], part) || shows(runs->images[1], part);
        }
        if (is_seen) parts.push_back(part);
    }
    setup.parts = std::move(parts);
}

/// Samples of the reference's runs that make a difference of means known best in a given time: of
/// var_t + v / s over t + c s, the s of the minimum.
int reference_samples(const ShortRuns& tested, const ShortRuns& reference)
{
    const double ratio =
        reference.variance * tested.seconds / std::max(tested.variance * reference.seconds, 1e-300);
    return static_cast<int>(std::lround(std::clamp(std::sqrt(ratio), 1.0, most_samples)));
}

int frames_of(const Setup& setup, const Method& method)
{
    return frames_rendered(setup.plan, method.keeps_history);
}

/// Frames before the one compared: an animation may have fewer than asked for.
int warm_up_of(const SceneDescription& scene, const VerifyParams& params)
{
    if (params.warm_up) return *params.warm_up;
    if (!is_animated(scene)) return default_warm_up;
    const int last = params.frame.value_or(scene.last_frame);
    return std::clamp(last - scene.first_frame, 0, default_warm_up);
}

std::optional<TemporalFigures> temporal_of(const Setup& setup, const VerifyResult& result)
{
    if (!setup.params.temporal || !setup.tested.keeps_history) return std::nullopt;
    setup.say("sequences: at rest, and after a step of lights and densities");
    const RenderDescription render = settings_of(setup, setup.tested, setup.passes);
    const TemporalInputs inputs{
        setup.scene,
        render,
        result.frame,
        std::max(result.warm_up, 1),
        setup.params.study.seed,
        temporal_share * setup.params.study.seconds,
        setup.hooks.stop,
    };
    return measure_temporal(inputs, result.study.reference_mean);
}

}  // namespace

VerifyResult verify_scene(const SceneDescription& scene, const VerifyParams& params,
                          const VerifyHooks& hooks)
{
    const auto start = std::chrono::steady_clock::now();
    VerifyResult result;
    result.path = scene.path;
    result.name = scene.name;
    result.hash = scene.hash;
    result.width = scene.render.width;
    result.height = scene.render.height;
    result.warm_up = warm_up_of(scene, params);
    result.frame = params.frame.value_or(scene.first_frame + result.warm_up);
    result.mode = is_animated(scene) ? BenchMode::Moving : BenchMode::Static;
    result.params = params.study;

    Setup setup{scene, params, hooks, {}, {}, {}, part_names, {}, {}, 1, 0};
    setup.tested = params.method.empty() ? own_method() : find_method(params.method);
    SceneCache scene_cache;
    setup.plan = plan_frames(scene, result.mode, result.frame, {result.warm_up, 1}, scene_cache);
    setup.last_frame = {{setup.plan.frames.back()}, 1};
    setup.reference = choose_reference(setup);

    setup.tested.keeps_history = history_matters(setup, setup.tested);

    const RenderDescription tested_settings = settings_of(setup, setup.tested, setup.passes);
    const bool is_biased = tested_settings.estimator == EstimatorKind::March ||
                           (tested_settings.estimator == EstimatorKind::Restir &&
                            !is_unbiased(tested_settings.restir));
    if (is_biased) result.params.question.equivalence = true;
    setup.say(fmt::format("short runs of {} and {}", setup.tested.name, setup.reference.name));
    setup.passes = std::max(params.passes, 1);
    ShortRuns tested = short_runs(source_of(setup, setup.tested, setup.passes), short_run_seed);
    if (params.passes == 0 && !setup.tested.keeps_history) {
        const double fitting = std::round(run_seconds / tested.seconds);
        setup.passes = static_cast<int>(std::clamp(fitting, 1.0, most_passes));
        tested = short_runs(source_of(setup, setup.tested, setup.passes), short_run_seed);
    }
    const ShortRuns reference =
        short_runs(source_of(setup, setup.reference, 1), short_run_seed + 2);
    if (image_mean(color_of(reference.images[0])) == 0.0 &&
        image_mean(color_of(tested.images[0])) == 0.0) {
        throw Error(ExitCode::Input, fmt::format("{}: the picture is black: nothing to compare",
                                                 printable(scene.path, 1000)));
    }
    choose_parts(setup, {&tested, &reference});
    const int samples = reference_samples(tested, reference);
    result.tested = {setup.tested.name, setup.passes, frames_of(setup, setup.tested),
                     tested.seconds};
    result.reference = {setup.reference.name, samples, frames_of(setup, setup.reference),
                        samples * reference.seconds};

    const double limit = params.study.seconds;
    if (limit > 0.0) {
        const double share = params.temporal && setup.tested.keeps_history ? temporal_share : 0.0;
        result.params.seconds = std::max((1.0 - share) * limit - seconds_since(start), 1e-3);
    }
    result.study = run_study(source_of(setup, setup.tested, setup.passes),
                             source_of(setup, setup.reference, samples), result.params, hooks.say);
    if (result.study.reference_mean.image_means.mean == 0.0 ||
        result.study.reference_mean.run_count < 2) {
        return result;
    }
    result.truncated_paths = setup.truncated_paths;
    result.errors = measure_errors(result.study);
    result.temporal = temporal_of(setup, result);
    return result;
}

}  // namespace mote
