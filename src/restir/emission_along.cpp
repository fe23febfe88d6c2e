#include "restir/emission_along.h"

#include <cmath>

#include "volumes/emission.h"
#include "volumes/media_at.h"

namespace mote {
namespace {

constexpr float cells_per_lookup = 2.0f;

/// Source function of all media at a point, each by its share of the extinction.
Spectrum mixed_source(const Media& media, Vec3 x, float time)
{
    if (media.volumes.size() == 1) {
        const Volume& volume = media.volumes.front();
        return source_at(volume, object_point(volume, x, time));
    }
    Spectrum j(0.0f);
    float sigma_t = 0.0f;
    for_each_medium_at(media, x, time, [&](const Volume& volume, Vec3 local, float own) {
        sigma_t += own;
        j += own * source_at(volume, object_from_local(volume).point(local));
    });
    return sigma_t > 0.0f ? j / sigma_t : Spectrum(0.0f);
}

bool is_source_constant(const Media& media)
{
    return media.volumes.size() == 1 && !media.volumes.front().temperature;
}

Spectrum source_along(const Media& media, const PixelDomain& domain, Rng& rng)
{
    const RayBins& bins = domain.bins;
    if (bins.empty()) return Spectrum(0.0f);
    if (is_source_constant(media)) {
        return -std::expm1(-bins.depth()) * source_at(media.volumes.front(), Vec3(0.0f));
    }
    Spectrum sum(0.0f);
    float u = 0.0f;
    for (int k = 0; k < bins.count; ++k) {
        // Opposite numbers in neighbouring bins: what is linear in the source cancels out.
        u = k % 2 == 0 ? rng.uniform() : 1.0f - u;
        const float lost = -std::expm1(-bins.depth_of_bin(k));
        const float share = std::exp(-bins.tau[k]) * lost;
        if (!(share > 0.0f)) continue;
        const float s = invert_bin(media, domain.ray, bins, k, -std::log1p(-u * lost));
        const Vec3 x = domain.ray.at(bins.world_t(s));
        sum += share * mixed_source(media, x, domain.ray.time);
    }
    return sum;
}

}  // namespace

Spectrum emission_along(const FrameDomain& frame, const PixelDomain& domain, Rng& rng)
{
    const Media& media = frame.scene->media;
    bool has_source = false;
    Spectrum sum(0.0f);
    for (const Volume& volume : media.volumes) {
        has_source |= volume.emission_params.blackbody_scale > 0.0f;
        sum += estimate_grid_emission(
            volume, domain.ray, {0.0f, domain.t_end()}, cells_per_lookup, rng, [&](float t, Vec3) {
                const auto s = static_cast<float>(static_cast<double>(t) - domain.bins.t0);
                return std::exp(-depth_to(media, domain.ray, domain.bins, s));
            });
    }
    if (has_source) sum += source_along(media, domain, rng);
    return sum;
}

}  // namespace mote
