#include "render/surface_pass.h"

#include <algorithm>
#include <cmath>

namespace mote {
namespace {

/// Gives a reservoir its own sample's light: `f` without shadow, `T` what the ray found. Targets
/// of reuse are compared between pixels, so p_hat must not keep what caches knew.
void set_light(PixelReservoir& own, SurfaceVisibility visibility, Spectrum f, float T)
{
    const bool is_exact = visibility == SurfaceVisibility::Exact;
    own.f = is_exact ? T * f : f;
    own.r.V = is_exact ? 1.0f : T;
    own.r.p_hat = luminance(own.f);
    const bool is_dropped = visibility == SurfaceVisibility::Reused && !(T > 0.0f);
    if (!(own.r.p_hat > 0.0f) || is_dropped) own.r.W = 0.0f;
}

}  // namespace

void resample_surface(const PassInputs& inputs, const PassKey& key, const SurfaceDomain& domain,
                      size_t groups, SurfaceChoice& choice, PassCounts& counts)
{
    const FrameDomain& frame = inputs.domain;
    Rng rng = pass_rng(inputs, key, Stream::Surface);
    (void)rng.uniform();  // decided whether the surface is sampled
    std::vector<Candidate>& all = choice.candidates;
    all.clear();
    draw_surface_candidates(frame, domain, rng, all);
    counts.candidates += static_cast<int64_t>(all.size());
    ++counts.surfaces;
    size_t lamps = all.size();
    if (frame.params.control_variate) {
        const auto is_lamp = [&](const Candidate& c) {
            const SampledLightKind kind = frame.lights[static_cast<size_t>(c.y.light)].kind;
            return kind == SampledLightKind::Lamp || kind == SampledLightKind::EmissiveVolume;
        };
        const auto end = std::stable_partition(all.begin(), all.end(), is_lamp);
        lamps = static_cast<size_t>(end - all.begin());
    }
    Spectrum unshadowed;
    choice.kept.clear();
    for (size_t g = 0; g == 0 || g < std::min(groups, lamps); ++g) {
        choice.group.clear();
        for (size_t i = g; i < lamps; i += groups) choice.group.push_back(all[i]);
        choice.kept.push_back(resample(choice.group, rng, unshadowed));
    }
    choice.apart = {all.data() + lamps, all.size() - lamps};
}

void ask_for_light(const FrameDomain& frame, const SurfaceDomain& domain, const Reservoir& r,
                   int owner, LightRays& rays)
{
    if (!(r.W > 0.0f)) return;
    const Candidate c = evaluate(frame, domain, r.y);
    rays.add(owner, c.x, c.arrival.wi, c.arrival.distance, domain.time, domain.share * r.W * c.f,
             infinity);
}

void ask_for_lights_apart(const SurfaceDomain& domain, const SurfaceChoice& choice, int owner,
                          LightRays& rays)
{
    for (const Candidate& c : choice.apart) {
        rays.add(owner, c.x, c.arrival.wi, c.arrival.distance, domain.time,
                 domain.share / c.density * c.f, infinity);
    }
}

void fill_surface_reservoirs(const PassInputs& inputs, const Tile& tile, uint32_t pass,
                             const Buffer2D<SurfaceDomain>& domains, SurfaceBuffers& out,
                             Buffer2D<FilmSample>& samples, PassCounts& counts)
{
    const FrameDomain& frame = inputs.domain;
    const SurfaceVisibility visibility = frame.params.surface.visibility;
    LightRays rays;
    LightRays apart;
    std::vector<PixelReservoir*> owners;
    std::vector<FilmSample*> apart_owners;
    SurfaceChoice choice;
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
            PixelReservoir& own = out.current.at(x, y);
            own = {};
            out.colors.at(x, y) = Spectrum(0.0f);
            const SurfaceDomain& domain = domains.at(x, y);
            if (!domain.is_sampled()) continue;
            resample_surface(inputs, {x, y, pass}, domain, 1, choice, counts);
            FilmSample& sample = samples.at(x, y);
            sample.work.x += static_cast<float>(choice.candidates.size());
            ask_for_lights_apart(domain, choice, static_cast<int>(apart_owners.size()), apart);
            apart_owners.push_back(&sample);
            own = choice.kept.front();
            if (!(own.r.W > 0.0f)) continue;
            const Candidate c = evaluate(frame, domain, own.r.y);
            if (visibility == SurfaceVisibility::None && !shades_all(frame.params)) {
                set_light(own, visibility, c.f, 1.0f);
                continue;
            }
            const auto owner = static_cast<int>(owners.size());
            owners.push_back(&own);
            rays.add(owner, c.x, c.arrival.wi, c.arrival.distance, domain.time, c.f, infinity);
            sample.exact_rays += 1.0f;
        }
    }
    rays.trace(*frame.scene, counts.light_rays);
    for (size_t i = 0; i < rays.size(); ++i) {
        set_light(*owners[static_cast<size_t>(rays.owners[i])], visibility, rays.weights[i],
                  std::exp(-rays.depths[i]));
    }
    apart.trace(*frame.scene, counts.light_rays);
    for (size_t i = 0; i < apart.size(); ++i) {
        FilmSample& sample = *apart_owners[static_cast<size_t>(apart.owners[i])];
        sample.surface_direct += apart.value(i);
        sample.exact_rays += 1.0f;
    }
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
            const PixelReservoir& own = out.current.at(x, y);
            if (own.r.W > 0.0f) out.colors.at(x, y) = (own.r.V * own.r.W) * own.f;
        }
    }
}

void shade_surface_reservoirs(const FrameDomain& frame, const Tile& tile,
                              const Buffer2D<SurfaceDomain>& domains, SurfaceBuffers& out,
                              PassCounts& counts)
{
    LightRays rays;
    std::vector<Spectrum*> owners;
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
            out.colors.at(x, y) = Spectrum(0.0f);
            const PixelReservoir& own = out.current.at(x, y);
            if (!(own.r.W > 0.0f)) continue;
            const SurfaceDomain& domain = domains.at(x, y);
            const Candidate c = evaluate(frame, domain, own.r.y);
            const auto owner = static_cast<int>(owners.size());
            owners.push_back(&out.colors.at(x, y));
            rays.add(owner, c.x, c.arrival.wi, c.arrival.distance, domain.time, own.r.W * c.f,
                     infinity);
        }
    }
    rays.trace(*frame.scene, counts.light_rays);
    for (size_t i = 0; i < rays.size(); ++i) {
        *owners[static_cast<size_t>(rays.owners[i])] = rays.value(i);
    }
}

}  // namespace mote
