#pragma once

#include <functional>
#include <memory>

#include "render/film.h"
#include "render/restir_frame.h"
#include "restir/correction_need.h"
#include "restir/domains.h"
#include "verify/tiles.h"

namespace mote::test {

/// How much work a comparison is. Each run has its own seed: the mean of a tile over a run is one
/// observation, as pixels of one run may be correlated.
struct Effort {
    int runs = 32;
    int samples = 6;              ///< per run, of the estimator under test
    int reference_samples = 128;  ///< per run, of the path tracer
};

/// The parts of the image that are compared beside it: lamps that the camera sees are noise.
inline const std::vector<std::string> part_names{
    "direct",          "indirect",        "emission",  "volume_direct",
    "volume_indirect", "volume_emission", "background"};

inline RenderDescription description(const TestScene& test, EstimatorKind estimator, int samples)
{
    RenderDescription render;
    render.width = test.scene.camera.width;
    render.height = test.scene.camera.height;
    render.samples = samples;
    render.estimator = estimator;
    render.path.max_bounces = test.max_bounces;
    render.path.equiangular = true;
    render.path.transmittance = TransmittanceKind::Exact;
    render.restir.reuse = ReuseMode::Off;
    return render;
}

/// Statistics over runs of image(seed), tiles of 4 x 4 pixels.
inline TileStats collect(int runs, uint32_t first_seed,
                         const std::function<LayeredImage(uint32_t)>& image)
{
    TileStats stats(4);
    for (int i = 0; i < runs; ++i) add_run(stats, image(first_seed + static_cast<uint32_t>(i)));
    return stats;
}

/// Runs of render_frame. One history serves all of them, so that caches are built once.
inline TileStats render_runs(const TestScene& test, RenderDescription render, int runs,
                             uint32_t first_seed)
{
    FrameHistory history;
    OutputDescription output;
    output.aovs = part_names;
    output.color_type = PixelType::Float;
    return collect(runs, first_seed, [&](uint32_t seed) {
        render.seed = seed;
        FrameStats stats;
        return render_frame(test.scene, render, output, history, nullptr, stats);
    });
}

/// The path tracer's runs.
inline TileStats reference_runs(const TestScene& test, const Effort& effort)
{
    return render_runs(test, description(test, EstimatorKind::Path, effort.reference_samples),
                       effort.runs, 100'000);
}

/// Runs of the passes alone, with caches of the caller's.
inline TileStats runs_with_caches(const TestScene& test, std::shared_ptr<const LightCaches> caches,
                                  RenderDescription render, int runs, uint32_t first_seed)
{
    FrameDomain domain = make_frame_domain(borrow(test.scene), std::move(caches), render.restir);
    domain.mean_known = mean_known_light(domain);
    const LightSampler lights(test.scene, render.path);
    return collect(runs, first_seed, [&](uint32_t seed) {
        render.seed = seed;
        const AovSet aovs = parse_aovs(part_names);
        const PassInputs inputs{domain, render, aovs, lights};
        Film film(render.width, render.height, aovs, PixelType::Float);
        PassCounts counts;
        int64_t dropped = 0;
        (void)render_independent_passes(inputs, {}, film, counts, dropped);
        return film.take();
    });
}

/// False alarms of one comparison of two sets of runs, over seeds: Welch's tests of all tiles and
/// of the whole image, Sidak and Bonferroni (see RunComparison). A hundred comparisons raise one
/// in 1,000 seeds.
constexpr double alarm = 1e-5;

/// What one channel of the whole image showed: "-0.12 % +- 0.10 %", tested over reference.
inline std::string ratio_text(const ChannelComparison& c)
{
    if (c.reference.mean == 0.0) return "reference is 0, tested " + std::to_string(c.tested.mean);
    const double ratio = c.tested.mean / c.reference.mean;
    const double variance = c.tested.variance + ratio * ratio * c.reference.variance;
    char text[100];
    std::snprintf(text, sizeof text, "%+.3f %% +- %.3f %%", 100.0 * (ratio - 1.0),
                  100.0 * std::sqrt(variance) / std::abs(c.reference.mean));
    return text;
}

/// All that differs from 0, for messages.
inline std::string summary(const std::string& name, const RunComparison& comparison)
{
    std::string text = name + ", p = " + std::to_string(comparison.p) + ":";
    for (const ChannelComparison& c : comparison.channels) {
        if (c.tested.mean == 0.0 && c.reference.mean == 0.0) continue;
        text += "\n  " + c.name + " " + ratio_text(c);
    }
    return text;
}

}  // namespace mote::test
