#include "volumes/emission.h"

#include "volumes/blackbody.h"
#include "volumes/brick_walk.h"

namespace mote {
namespace {

float sample_scalar(const BrickGrid* grid, Vec3 p_object)
{
    return grid ? sample_trilinear(*grid, grid->index_from_object.point(p_object)) : 0.0f;
}

bool has_density(const Volume& volume)
{
    return volume.density && !volume.density->index_bounds.is_empty();
}

Affine object_from_local(const BrickGrid& grid)
{
    const Mat3 linear = glm::inverse(grid.index_from_object.linear);
    return {linear, linear * (Vec3(grid.lo) - grid.index_from_object.offset)};
}

/// The black-body term of j at a point whose density is known.
Spectrum glow(const Volume& volume, float density, Vec3 p_object)
{
    if (density <= 0.0f) return Spectrum(0.0f);
    const float T = temperature_at(volume, p_object);
    if (!(T > 0.0f)) return Spectrum(0.0f);
    const float strength = volume.emission_params.blackbody_scale * volume.density_scale * density;
    return strength * sqr(sqr(T * (1.0f / 1500.0f))) * blackbody_rgb(T);
}

/// Sum over the bricks of one grid of span length times j(one jittered point of the span).
template <class Lookup>
Spectrum integrate_jittered(const BrickGrid& grid, const LocalRay& ray, Rng& rng, Lookup&& j_at)
{
    Spectrum sum(0.0f);
    for_each_brick(grid, ray, [&](const BrickSpan& span) {
        const float length = span.s1 - span.s0;
        const float s = span.s0 + rng.uniform() * length;
        const Vec3 p = ray.at(s);
        sum += length * j_at(sample_in_brick(grid, span, p), p, ray.world_t(s));
        return true;
    });
    return sum;
}

/// Both terms of j along a ray, each lookup multiplied by weight(t, object_from_local, p_local).
template <class Weight>
Spectrum integrate_terms(const Volume& volume, const Ray& ray, Interval range, Rng& rng,
                         Weight&& weight)
{
    const Emission& e = volume.emission_params;
    if (!e.is_on()) return Spectrum(0.0f);
    const VolumeFrames frames = frames_at(volume, ray.time);
    Spectrum sum(0.0f);
    if (e.emission_scale > 0.0f && volume.emission && !volume.emission->index_bounds.is_empty()) {
        const BrickGrid& grid = *volume.emission;
        const LocalRay local = make_local_ray(grid, frames.emission, ray, range);
        const Affine to_object = object_from_local(grid);
        const Spectrum per_unit = e.emission_scale * e.emission_color;
        sum += integrate_jittered(grid, local, rng, [&](float value, Vec3 p, float t) {
            return value > 0.0f ? value * weight(t, to_object, p) * per_unit : Spectrum(0.0f);
        });
    }
    if (e.blackbody_scale > 0.0f && has_density(volume)) {
        const BrickGrid& grid = *volume.density;
        const LocalRay local = make_local_ray(grid, frames.density, ray, range);
        const Affine to_object = object_from_local(volume);
        sum += integrate_jittered(grid, local, rng, [&](float density, Vec3 p, float t) {
            if (!(density > 0.0f)) return Spectrum(0.0f);
            return weight(t, to_object, p) * glow(volume, density, to_object.point(p));
        });
    }
    return sum;
}

}  // namespace

float temperature_at(const Volume& volume, Vec3 p_object)
{
    const Emission& e = volume.emission_params;
    return e.temperature_scale * sample_scalar(volume.temperature.get(), p_object) +
           e.temperature_offset;
}

Spectrum emission_at(const Volume& volume, Vec3 p_object)
{
    const Emission& e = volume.emission_params;
    Spectrum j(0.0f);
    if (e.emission_scale > 0.0f && volume.emission) {
        j += e.emission_scale * sample_scalar(volume.emission.get(), p_object) * e.emission_color;
    }
    if (e.blackbody_scale > 0.0f) {
        j += glow(volume, sample_scalar(volume.density.get(), p_object), p_object);
    }
    return j;
}

Spectrum estimate_emission(const Volume& volume, const Ray& ray, Interval range, Rng& rng)
{
    return integrate_terms(
        volume, ray, range, rng,
        [](float /*t*/, const Affine& /*to_object*/, Vec3 /*p*/) { return 1.0f; });
}

Spectrum estimate_emission(const Volume& volume, const Ray& ray, Interval range, Rng& rng,
                           const EmissionWeight& weight)
{
    return integrate_terms(volume, ray, range, rng, [&](float t, const Affine& to_object, Vec3 p) {
        return weight(t, to_object.point(p));
    });
}

}  // namespace mote
