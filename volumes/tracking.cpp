#include "volumes/tracking.h"

#include "volumes/cell_walk.h"
#include "volumes/collisions.h"
#include "volumes/media_at.h"

namespace mote {
namespace {

/// Beyond this optical depth a float's exp(-tau) is 0.
constexpr float opaque = 104.0f;

Collision collision_at(const Volume& volume, const LocalRay& local, float s)
{
    return {local.world_t(s), -1, object_from_local(volume).point(local.at(s))};
}

/// Optical depth, given up beyond `limit`.
float optical_depth_up_to(const Volume& volume, const Ray& ray, Interval range, double limit)
{
    if (is_void(volume)) return 0.0f;
    const LocalRay local = density_ray(volume, ray, range);
    double sum = 0.0;
    int64_t bricks = 0;
    const double stop = limit / static_cast<double>(volume.density_scale);
    for_each_brick(*volume.density, local, [&](const BrickSpan& span) {
        sum += static_cast<double>(integrate_brick(*volume.density, local, span));
        ++bricks;
        return sum < stop;
    });
    tracking_counts.closed_bricks += bricks;
    return static_cast<float>(sum * static_cast<double>(volume.density_scale));
}

}  // namespace

std::optional<Collision> sample_free_flight(const Media& media, const Ray& ray, Interval range,
                                            Rng& rng)
{
    std::optional<Collision> nearest;
    for (size_t i = 0; i < media.volumes.size(); ++i) {
        const Volume& volume = media.volumes[i];
        if (is_void(volume)) continue;
        const LocalRay local = density_ray(volume, ray, range);
        if (local.misses()) continue;
        ++tracking_counts.free_flights;
        const float s = track_delta(*volume.density, local, volume.density_scale, rng);
        if (s < 0.0f) continue;
        nearest = collision_at(volume, local, s);
        nearest->volume = static_cast<int>(i);
        range.t1 = nearest->t;  // only a nearer collision of another volume counts
    }
    return nearest;
}

std::optional<Collision> invert_optical_depth(const Volume& volume, const Ray& ray, Interval range,
                                              float tau)
{
    if (is_void(volume)) return std::nullopt;
    const BrickGrid& grid = *volume.density;
    const LocalRay local = density_ray(volume, ray, range);
    double left = static_cast<double>(tau) / static_cast<double>(volume.density_scale);
    std::optional<Collision> found;
    for_each_brick(grid, local, [&](const BrickSpan& span) {
        return for_each_cell(grid, local, span, [&](const CellSpan& cell) {
            const double integral = static_cast<double>(cell.integral());
            if (left >= integral) {
                left -= integral;
                return true;
            }
            const float s = invert_cell(grid, local, span, cell, static_cast<float>(left));
            found = collision_at(volume, local, s);
            return false;
        });
    });
    return found;
}

float estimate_transmittance(const Media& media, const Ray& ray, Interval range,
                             TransmittanceKind kind, Rng& rng)
{
    float T = 1.0f;
    for (const Volume& volume : media.volumes) {
        if (is_void(volume)) continue;
        ++tracking_counts.shadow_rays;
        if (kind == TransmittanceKind::Exact) {
            T *= std::exp(-optical_depth_up_to(volume, ray, range, static_cast<double>(opaque)));
        } else {
            const LocalRay local = density_ray(volume, ray, range);
            if (local.misses()) continue;
            const float scale = volume.density_scale;
            T *= kind == TransmittanceKind::Ratio
                     ? track_ratio(*volume.density, local, scale, rng)
                     : track_residual_ratio(*volume.density, local, scale, rng);
        }
        if (T == 0.0f) break;
    }
    return T;
}

float optical_depth(const Volume& volume, const Ray& ray, Interval range)
{
    return optical_depth_up_to(volume, ray, range, std::numeric_limits<double>::infinity());
}

float optical_depth(const Media& media, const Ray& ray, Interval range)
{
    float sum = 0.0f;
    for (const Volume& volume : media.volumes) sum += optical_depth(volume, ray, range);
    return sum;
}

Spectrum albedo_at(const Volume& volume, Vec3 p_object)
{
    if (!volume.color) return volume.albedo;
    const Spectrum color = volume.albedo * sample_color(*volume.color, p_object);
    return glm::clamp(color, Spectrum(0.0f), Spectrum(1.0f));
}

float sigma_t_at(const Volume& volume, Vec3 p_object)
{
    if (is_void(volume)) return 0.0f;
    const BrickGrid& grid = *volume.density;
    return volume.density_scale * sample_trilinear(grid, grid.index_from_object.point(p_object));
}

float sigma_t_at(const Media& media, Vec3 p, float time)
{
    float sum = 0.0f;
    for_each_medium_at(
        media, p, time,
        [&](const Volume& /*volume*/, Vec3 /*local*/, float sigma_t) { sum += sigma_t; });
    return sum;
}

Vec3 velocity_at(const Volume& volume, Vec3 p_object)
{
    return volume.velocity ? sample_color(*volume.velocity, p_object) : Vec3(0.0f);
}

}  // namespace mote
