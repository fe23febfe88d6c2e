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
#include "study/verify_pilots.h"

namespace mote {

namespace {

constexpr int default_warm_up = 8;
/// In motion history is worth little (TemporalParams::cap), so it is what it will be soon.
constexpr int moving_warm_up = 4;
/// Of runs whose passes are independent anyway: shorter ones would pay more for keeping the books.
constexpr double run_seconds = 0.2;
constexpr double most_passes = 64.0;
/// Of the time for the study, at most, for sequences.
constexpr double temporal_share = 0.1;

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

/// The path tracer of least variance times time. With lamps nearby only those with equiangular
/// distances: the others' variance is infinite, and t-tests want finite ones.
Method choose_reference(const VerifySetup& setup)
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

/// Whether the frames before change the last one at all, by a run with and one without them.
bool history_matters(VerifySetup& setup, const Method& method)
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

int frames_of(const VerifySetup& setup, const Method& method)
{
    return frames_rendered(setup.plan, method.keeps_history);
}

/// Frames before the one compared: an animation may have fewer than asked for.
int warm_up_of(const SceneDescription& scene, const VerifyParams& params)
{
    if (params.warm_up) return *params.warm_up;
    if (!is_animated(scene)) return default_warm_up;
    const int last = params.frame.value_or(scene.last_frame);
    return std::clamp(last - scene.first_frame, 0, moving_warm_up);
}

std::optional<TemporalFigures> temporal_of(const VerifySetup& setup, const VerifyResult& result)
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

    VerifySetup setup{scene, params, hooks, {}, {}, {}, {}, part_names(), {}, {}, {}, 1, 0};
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
