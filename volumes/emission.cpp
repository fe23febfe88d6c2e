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
    return volume.density_scale * density * source_at(volume, p_object);
}

constexpr float one_per_brick = infinity;

/// Sum over the bricks of one grid of length times j(one jittered point) of each span of at most
/// so many cells.
template <class Lookup>
Spectrum integrate_jittered(const BrickGrid& grid, const LocalRay& ray, float cells_per_lookup,
                            Rng& rng, Lookup&& j_at)
{
    const float cells_per_length = max_component(glm::abs(ray.d));
    Spectrum sum(0.0f);
    for_each_brick(grid, ray, [&](const BrickSpan& span) {
        const float whole = span.s1 - span.s0;
        const int parts = 1 + static_cast<int>(whole * cells_per_length / cells_per_lookup);
        const float length = whole / static_cast<float>(parts);
        for (int i = 0; i < parts; ++i) {
            const float s = span.s0 + (static_cast<float>(i) + rng.uniform()) * length;
            const Vec3 p = ray.at(s);
            sum += length * j_at(sample_in_brick(grid, span, p), p, ray.world_t(s));
        }
        return true;
    });
    return sum;
}

/// The emission grid's term along a ray, each lookup multiplied by
/// weight(t, object_from_local, p_local).
template <class Weight>
Spectrum integrate_grid_term(const Volume& volume, const Ray& ray, Interval range,
                             float cells_per_lookup, Rng& rng, Weight&& weight)
{
    const Emission& e = volume.emission_params;
    if (!(e.emission_scale > 0.0f) || !volume.emission ||
        volume.emission->index_bounds.is_empty()) {
        return Spectrum(0.0f);
    }
    const BrickGrid& grid = *volume.emission;
    const LocalRay local = make_local_ray(grid, frames_at(volume, ray.time).emission, ray, range);
    const Affine to_object = object_from_local(grid);
    const Spectrum per_unit = e.emission_scale * e.emission_color;
    return integrate_jittered(
        grid, local, cells_per_lookup, rng, [&](float value, Vec3 p, float t) {
            return value > 0.0f ? value * weight(t, to_object, p) * per_unit : Spectrum(0.0f);
        });
}

/// Both terms of j along a ray.
template <class Weight>
Spectrum integrate_terms(const Volume& volume, const Ray& ray, Interval range, Rng& rng,
                         Weight&& weight)
{
    const Emission& e = volume.emission_params;
    if (!e.is_on()) return Spectrum(0.0f);
    Spectrum sum = integrate_grid_term(volume, ray, range, one_per_brick, rng, weight);
    if (e.blackbody_scale > 0.0f && has_density(volume)) {
        const BrickGrid& grid = *volume.density;
        const LocalRay local =
            make_local_ray(grid, frames_at(volume, ray.time).density, ray, range);
        const Affine to_object = object_from_local(volume);
        sum += integrate_jittered(
            grid, local, one_per_brick, rng, [&](float density, Vec3 p, float t) {
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

Spectrum source_at(const Volume& volume, Vec3 p_object)
{
    const float scale = volume.emission_params.blackbody_scale;
    if (!(scale > 0.0f)) return Spectrum(0.0f);
    const float T = temperature_at(volume, p_object);
    if (!(T > 0.0f)) return Spectrum(0.0f);
    return scale * sqr(sqr(T * (1.0f / 1500.0f))) * blackbody_rgb(T);
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

Spectrum estimate_grid_emission(const Volume& volume, const Ray& ray, Interval range,
                                float cells_per_lookup, Rng& rng, const EmissionWeight& weight)
{
    return integrate_grid_term(
        volume, ray, range, cells_per_lookup, rng,
        [&](float t, const Affine& to_object, Vec3 p) { return weight(t, to_object.point(p)); });
}

}  // namespace mote
