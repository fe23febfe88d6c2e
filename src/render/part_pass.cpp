#include "render/part_pass.h"

#include "render/indirect_pass.h"
#include "render/seen_lamps.h"

namespace mote {
namespace {

/// Samples of a surface's lamps that get a shadow ray each where nothing is reused. Measured
/// against one: bench_lights_room twice as efficient (trimmed), spinning_swirl 1.5 times, others
/// alike.
constexpr size_t shaded_alone = 4;

void trace_part(const PassInputs& inputs, const DuePart& due, PixelDomain& domain,
                PartScratch& scratch, PassCounts& counts)
{
    const PassKey& key = due.key;
    const FrameDomain& frame = inputs.domain;
    const auto owner = static_cast<int>(scratch.samples.size());
    FilmSample& sample = scratch.samples.emplace_back();
    sample.weight = due.part.weight;
    const SurfaceDomain& surface = scratch.surface;
    begin_pass(inputs, key, domain, owner, scratch.surface, scratch.rays, scratch.first, sample,
               counts);
    if (inputs.render.path.max_bounces == 0) return;
    if (surface.is_sampled()) {
        SurfaceChoice& choice = scratch.choice;
        resample_surface(inputs, key, surface, shaded_alone, choice, counts);
        for (const PixelReservoir& kept : choice.kept) {
            ask_for_light(frame, surface, kept.r, owner, scratch.surface_rays);
        }
        ask_for_lights_apart(surface, choice, owner, scratch.surface_rays);
        sample.work.x += static_cast<float>(choice.candidates.size());
    }
    if (!frame.has_sampled_lights() || domain.bins.empty()) return;
    weigh_bins(frame, domain);
    Rng rng = pass_rng(inputs, key, Stream::Initial);
    scratch.candidates.clear();
    draw_candidates(frame, domain, frame.params.candidates, rng, scratch.candidates);
    counts.candidates += static_cast<int64_t>(scratch.candidates.size());
    sample.work.x += static_cast<float>(scratch.candidates.size());
    for (const Candidate& c : scratch.candidates) {
        const Spectrum weight = c.f / c.density;
        scratch.rays.exact.add(owner, c.x, c.arrival.wi, c.arrival.distance, domain.ray.time,
                               weight, depth_that_matters(weight, luminance(sample.L())));
    }
}

}  // namespace

void PartScratch::clear()
{
    samples.clear();
    rays.clear();
    surface_rays.clear();
    lamp_rays.clear();
    first.clear();
}

void trace_parts(const PassInputs& inputs, std::span<const DuePart> parts, PartScratch& scratch,
                 PassCounts& counts)
{
    for_each_domain(
        inputs.domain, parts.size(), [&](size_t i) -> const Ray& { return parts[i].part.ray; },
        scratch.domains, counts.bins,
        [&](size_t i, PixelDomain& domain) {
            trace_part(inputs, parts[i], domain, scratch, counts);
        });
}

void shade_parts(const PassInputs& inputs, const PassKey& key, PartScratch& scratch,
                 PassCounts& counts)
{
    const FrameDomain& frame = inputs.domain;
    const std::vector<Spectrum> shared = light_shared_paths(inputs, key, scratch.first, counts);
    for (size_t i = 0; i < shared.size(); ++i) scratch.samples[i].indirect += shared[i];
    scratch.rays.trace(frame, counts.guesses, counts.light_rays, [&](int of, Spectrum value) {
        FilmSample& sample = scratch.samples[static_cast<size_t>(of)];
        sample.direct += value;
        sample.exact_rays += 1.0f;
    });
    add_seen_lamps(*frame.scene, scratch.lamp_rays, counts.lamps,
                   [&](int of) -> FilmSample& { return scratch.samples[static_cast<size_t>(of)]; });
    scratch.surface_rays.trace(*frame.scene, counts.light_rays);
    for (size_t i = 0; i < scratch.surface_rays.size(); ++i) {
        FilmSample& sample = scratch.samples[static_cast<size_t>(scratch.surface_rays.owners[i])];
        sample.surface_direct += scratch.surface_rays.value(i);
        sample.exact_rays += 1.0f;
    }
}

}  // namespace mote
