#include "render/surface_pass.h"

namespace mote {

PixelReservoir resample_surface(const PassInputs& inputs, const PassKey& key,
                                const SurfaceDomain& domain, std::vector<Candidate>& candidates,
                                PassCounts& counts)
{
    Rng rng = pass_rng(inputs, key, Stream::Surface);
    (void)rng.uniform();  // decided whether the surface is sampled
    const size_t first = candidates.size();
    draw_surface_candidates(inputs.domain, domain, rng, candidates);
    counts.candidates += static_cast<int64_t>(candidates.size() - first);
    ++counts.surfaces;
    Spectrum unshadowed;
    return resample({candidates.data() + first, candidates.size() - first}, rng, unshadowed);
}

void ask_for_light(const FrameDomain& frame, const SurfaceDomain& domain, const Reservoir& r,
                   int owner, LightRays& rays)
{
    if (!(r.W > 0.0f)) return;
    const Candidate c = evaluate(frame, domain, r.y);
    rays.add(owner, c.x, c.arrival.wi, c.arrival.distance, domain.time, domain.share * r.W * c.f,
             infinity);
}

void fill_surface_reservoirs(const PassInputs& inputs, const Tile& tile, uint32_t pass,
                             const Buffer2D<SurfaceDomain>& domains, SurfaceBuffers& out,
                             PassCounts& counts)
{
    const FrameDomain& frame = inputs.domain;
    LightRays rays;
    std::vector<PixelReservoir*> owners;
    std::vector<Candidate> candidates;
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
            PixelReservoir& own = out.current.at(x, y);
            own = {};
            const SurfaceDomain& domain = domains.at(x, y);
            if (!domain.is_sampled()) continue;
            candidates.clear();
            own = resample_surface(inputs, {x, y, pass}, domain, candidates, counts);
            if (!(own.r.W > 0.0f)) continue;
            const Candidate c = evaluate(frame, domain, own.r.y);
            const auto owner = static_cast<int>(owners.size());
            owners.push_back(&own);
            rays.add(owner, c.x, c.arrival.wi, c.arrival.distance, domain.time, c.f, infinity);
        }
    }
    rays.trace(*frame.scene, counts.light_rays);
    for (size_t i = 0; i < rays.size(); ++i) {
        PixelReservoir& own = *owners[static_cast<size_t>(rays.owners[i])];
        own.f = rays.value(i);
        own.r.p_hat = luminance(own.f);
        if (!(own.r.p_hat > 0.0f)) own.r.W = 0.0f;
    }
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
            const PixelReservoir& own = out.current.at(x, y);
            out.colors.at(x, y) = own.r.W > 0.0f ? own.r.W * own.f : Spectrum(0.0f);
        }
    }
}

}  // namespace mote
