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
#include "runs/run_error.h"

namespace mote {

namespace {

constexpr int default_warm_up = 8;
constexpr double most_samples = 4096.0;
/// Of runs whose passes are independent anyway: shorter ones would pay more for keeping the books.
constexpr double run_seconds = 0.2;
constexpr double most_passes = 64.0;
/// Differs from the run's own, so that its camera rays do.
constexpr uint32_t straight_seed_bits = 0x80000000u;
constexpr int straight_pilot_passes = 16;
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
    PlanCaches straight_caches;
    std::vector<std::string> parts;  ///< layers that show anything
    StraightLight straight;
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

/// The last frame without events.
LayeredImage straight_run(Setup& setup, const Method& method, int passes, uint32_t seed)
{
    RenderDescription render = settings_of(setup, method, passes);
    render.path.max_bounces = 0;
    render.seed = seed;
    LayeredImage last;
    play_frames(setup.last_frame, false, render, float_output(setup.parts), setup.hooks.stop,
                render.estimator == EstimatorKind::Restir ? &setup.straight_caches : nullptr,
                [&](size_t, const LayeredImage& image, const FrameStats& stats) {
                    last = image;
                    require_sound(stats, seed);
                });
    return last;
}

/// Runs of a method, each of which is the plan's last frame from empty history; straight light from
/// passes of its own, if there are any.
RunSource source_of(Setup& setup, const Method& method, int samples, int straight_passes = 0)
{
    return [&setup, method, straight_passes, render = settings_of(setup, method, samples),
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
        if (straight_passes > 0) {
            replace_parts(last,
                          straight_run(setup, method, straight_passes, seed ^ straight_seed_bits),
                          setup.straight.parts);
        }
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

/// Of a pixel, by two images, without the share of the pixels where it is largest.
double variance_between(const LayeredImage& a, const LayeredImage& b, double left_out)
{
    PixelStats stats;
    for (const LayeredImage* image : {&a, &b}) {
        Buffer2D<Spectrum> color = color_of(*image);
        replace_non_finite(color);
        add_run(stats, color);
    }
    return trimmed_mean_variance(stats, left_out);
}

ShortRuns short_runs(const RunSource& source, uint32_t seed)
{
    ShortRuns runs;
    for (uint32_t k = 0; k < 2; ++k) {
        const auto start = std::chrono::steady_clock::now();
        runs.images[k] = source(seed + k);
        runs.seconds = std::max(seconds_since(start), 1e-6);
    }
    runs.variance = variance_between(runs.images[0], runs.images[1], trimmed_share);
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

/// Short runs of one estimator, and of its frames without events.
struct Pilots {
    const Method& method;
    int samples;
    uint32_t seed;
    ShortRuns runs;
    ShortRuns straight;

    Pilots(Setup& setup, const Method& m, int n, uint32_t s)
        : method(m),
          samples(n),
          seed(s),
          runs(short_runs(source_of(setup, m, n), s)),
          straight(short_runs(
              [&](uint32_t k) { return straight_run(setup, m, straight_pilot_passes, k); }, s))
    {
    }
    [[nodiscard]] double rest_variance(const std::vector<std::string>& parts, double left_out) const
    {
        return variance_between(without_parts(runs.images[0], parts),
                                without_parts(runs.images[1], parts), left_out);
    }
    /// Of one pass.
    [[nodiscard]] double straight_variance(const std::vector<std::string>& parts) const
    {
        return straight_pilot_passes * variance_between(only_parts(straight.images[0], parts),
                                                        only_parts(straight.images[1], parts), 0.0);
    }
};

/// Samples of the reference's runs that make a difference of means known best in a given time: of
/// var_t + v / s over t + c s, the s of the minimum.
int reference_samples(const ShortRuns& tested, const ShortRuns& reference)
{
    const double ratio =
        reference.variance * tested.seconds / std::max(tested.variance * reference.seconds, 1e-300);
    return static_cast<int>(std::lround(std::clamp(std::sqrt(ratio), 1.0, most_samples)));
}

/// Takes straight light from passes of its own where it makes most of the tested runs' noise, and
/// chooses the reference's samples for the rest; returns those.
int share_out(Setup& setup, Pilots& tested, Pilots& reference)
{
    // Of the reference it is true by definition.
    const std::vector<std::string> parts = straight_parts(
        tested.runs.images[0], straight_run(setup, tested.method, tested.samples, tested.seed),
        setup.parts);
    // One pass shows about the same in both, and either may have missed what is rare.
    const double pass_variance =
        std::max(tested.straight_variance(parts), reference.straight_variance(parts));
    const bool is_worth_it =
        pass_variance / tested.samples > tested.rest_variance(parts, trimmed_share);
    if (is_worth_it) {
        for (Pilots* p : {&tested, &reference}) {
            p->runs.variance = p->rest_variance(parts, trimmed_share);
        }
    }
    const int samples = reference_samples(tested.runs, reference.runs);
    if (!is_worth_it) return samples;
    const double rest = tested.runs.variance + reference.runs.variance / samples;
    const double seconds = tested.runs.seconds + samples * reference.runs.seconds;
    const auto passes_of = [&](const Pilots& p) {
        return best_straight_passes(pass_variance, p.straight.seconds / straight_pilot_passes, rest,
                                    seconds);
    };
    setup.straight = {parts, passes_of(tested), passes_of(reference)};
    return samples;
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

    Setup setup{scene, params, hooks, {}, {}, {}, {}, part_names, {}, {}, {}, 1, 0};
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
    if (params.passes == 0 && !setup.tested.keeps_history) {
        const double seconds =
            short_runs(source_of(setup, setup.tested, 1), short_run_seed).seconds;
        setup.passes =
            static_cast<int>(std::clamp(std::round(run_seconds / seconds), 1.0, most_passes));
    }
    Pilots tested(setup, setup.tested, setup.passes, short_run_seed);
    Pilots reference(setup, setup.reference, 1, short_run_seed + 2);
    if (image_mean(color_of(reference.runs.images[0])) == 0.0 &&
        image_mean(color_of(tested.runs.images[0])) == 0.0) {
        throw Error(ExitCode::Input, fmt::format("{}: the picture is black: nothing to compare",
                                                 printable(scene.path, 1000)));
    }
    choose_parts(setup, {&tested.runs, &reference.runs, &tested.straight, &reference.straight});
    const int samples = share_out(setup, tested, reference);
    result.straight = setup.straight;
    result.tested = {setup.tested.name, setup.passes, frames_of(setup, setup.tested),
                     tested.runs.seconds};
    result.reference = {setup.reference.name, samples, frames_of(setup, setup.reference),
                        samples * reference.runs.seconds};

    const double limit = params.study.seconds;
    if (limit > 0.0) {
        const double share = params.temporal && setup.tested.keeps_history ? temporal_share : 0.0;
        result.params.seconds = std::max((1.0 - share) * limit - seconds_since(start), 1e-3);
    }
    result.study =
        run_study(source_of(setup, setup.tested, setup.passes, setup.straight.tested_passes),
                  source_of(setup, setup.reference, samples, setup.straight.reference_passes),
                  result.params, hooks.say);
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
