#include "study/verify_runs.h"

#include <fmt/format.h>

#include "core/error.h"

namespace mote {

namespace {

/// Differs from the run's own, so that its camera rays do.
constexpr uint32_t straight_seed_bits = 0x80000000u;
constexpr uint32_t straight_seed_step = 0x00100000u;  // more than there are runs

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

}  // namespace

const std::vector<std::string>& part_names()
{
    static const std::vector<std::string> names{
        "volume_direct", "volume_indirect", "volume_emission", "direct",
        "indirect",      "emission",        "background",      "transmittance"};
    return names;
}

RenderDescription settings_of(const VerifySetup& setup, const Method& method, int samples)
{
    RenderDescription render = setup.scene.render;
    method.edit(render);
    render.samples = samples;
    return render;
}

LayeredImage straight_run(VerifySetup& setup, const Method& method, int passes, uint32_t seed)
{
    const bool plays_frames = setup.straight.plays_frames && method.keeps_history;
    const FramePlan& plan = plays_frames ? setup.plan : setup.last_frame;
    const int per_play = setup.passes * static_cast<int>(plan.frames.size());
    const int plays = plays_frames ? std::max(1, passes / per_play) : 1;
    RenderDescription render = settings_of(setup, method, plays_frames ? setup.passes : passes);
    render.path.max_bounces = 0;
    PlanCaches& caches = plays_frames ? setup.caches : setup.straight_caches;
    LayeredImage mean;
    for (int k = 0; k < plays; ++k) {
        render.seed = seed + static_cast<uint32_t>(k) * straight_seed_step;
        LayeredImage last;
        play_frames(plan, plays_frames, render, float_output(setup.parts), setup.hooks.stop,
                    render.estimator == EstimatorKind::Restir ? &caches : nullptr,
                    [&](size_t, const LayeredImage& image, const FrameStats& stats) {
                        last = image;
                        require_sound(stats, render.seed);
                    });
        add_image(mean, last, 1.0f / static_cast<float>(plays));
    }
    return mean;
}

RunSource source_of(VerifySetup& setup, const Method& method, int samples, int straight_passes)
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
                        setup.truncated_paths += stats.truncation.paths;
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

}  // namespace mote
