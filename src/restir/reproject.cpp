#include "restir/reproject.h"

#include <algorithm>
#include <cmath>

#include "restir/same.h"
#include "volumes/media_at.h"

namespace mote {
namespace {

/// Distance along the ray at which a share of its collisions has happened, linear inside bins.
float distance_of_share(const RayBins& bins, float share)
{
    const float lost = -std::expm1(-bins.depth());
    const float tau = -std::log1p(-share * lost);
    const auto above = std::upper_bound(bins.tau + 1, bins.tau + bins.count, tau) - bins.tau;
    const int k = static_cast<int>(above) - 1;
    const float depth = bins.depth_of_bin(k);
    const float within = depth > 0.0f ? (tau - bins.tau[k]) / depth : 0.0f;
    return bins.s[k] + within * (bins.s[k + 1] - bins.s[k]);
}

/// Optical depth at a distance, linear inside bins.
float approximate_depth(const RayBins& bins, float s)
{
    if (bins.empty() || s <= bins.s[0]) return 0.0f;
    if (s >= bins.s[bins.count]) return bins.depth();
    const int k = bin_of(bins, s);
    const float length = bins.s[k + 1] - bins.s[k];
    const float within = length > 0.0f ? (s - bins.s[k]) / length : 0.0f;
    return bins.tau[k] + within * bins.depth_of_bin(k);
}

/// Where the media's particles at x were in the frame before, mean weighted by extinction.
Vec3 earlier_position(const FrameDomain& before, const FrameDomain& now, Vec3 x, float time)
{
    const auto& volumes = now.scene->media.volumes;
    const auto& earlier = before.scene->media.volumes;
    if (earlier.size() != volumes.size()) return x;
    // The same frame again (another pass of it) has not moved.
    const double frames = now.scene->frame - before.scene->frame;
    const double seconds = frames / now.scene->fps;
    Vec3d sum(0.0);
    double weight = 0.0;
    for_each_medium_at(now.scene->media, x, time, [&](const Volume& volume, Vec3, float sigma_t) {
        const auto i = static_cast<size_t>(&volume - volumes.data());
        const Vec3 p_object = object_point(volume, x, time);
        const Vec3d p = Vec3d(p_object) - seconds * Vec3d(velocity_at(volume, p_object));
        const Mat4d world_from_object = matrix(earlier[i].world_from_object.at(time));
        sum += static_cast<double>(sigma_t) * Vec3d(world_from_object * glm::dvec4(p, 1.0));
        weight += static_cast<double>(sigma_t);
    });
    return weight > 0.0 ? Vec3(sum / weight) : x;
}

}  // namespace

Change change_between(const FrameDomain& before, const FrameDomain& now)
{
    const Scene& a = *before.scene;
    const Scene& b = *now.scene;
    Change change;
    change.camera = !is_same(a.camera.world_from_camera, b.camera.world_from_camera) ||
                    a.camera.tan_half_fov_y != b.camera.tan_half_fov_y ||
                    a.camera.lens_radius != b.camera.lens_radius ||
                    a.camera.focus_distance != b.camera.focus_distance ||
                    a.camera.width != b.camera.width || a.camera.height != b.camera.height;
    change.media = !(before.caches->media == now.caches->media) ||
                   !std::equal(a.media.volumes.begin(), a.media.volumes.end(),
                               b.media.volumes.begin(), b.media.volumes.end(), is_same_look);
    change.lights = !have_same_lamps(a.lights, b.lights) ||
                    a.environment.has_value() != b.environment.has_value() ||
                    (a.environment && !is_same(*a.environment, *b.environment));
    change.surfaces = !is_same(a.surfaces.get(), b.surfaces.get());
    return change;
}

std::optional<PreviousPixel> previous_pixel(const FrameDomain& before, const FrameDomain& now,
                                            const PixelDomain& domain, bool moved)
{
    if (!(domain.bins.depth() > 0.0f)) return std::nullopt;
    const float s = distance_of_share(domain.bins, 0.5f);
    const Vec3 x = domain.ray.at(domain.bins.world_t(s));
    const Vec3 earlier = moved ? earlier_position(before, now, x, domain.ray.time) : x;
    const Camera& camera = before.scene->camera;
    const std::optional<Vec2> film = project(camera, earlier, domain.ray.time);
    if (!film || !(film->x >= 0.0f) || !(film->y >= 0.0f)) return std::nullopt;
    PreviousPixel out{static_cast<int>(film->x), static_cast<int>(film->y), x - earlier};
    if (out.x >= camera.width || out.y >= camera.height) return std::nullopt;
    return out;
}

float profile_agreement(const RayBins& own, const RayBins& other, const RayMap& other_from_own,
                        float strength)
{
    if (!(strength > 0.0f)) return 1.0f;
    float sum = std::abs(std::exp(-own.depth()) - std::exp(-other.depth()));
    constexpr int shares = 4;
    for (int i = 1; i <= shares && !own.empty(); ++i) {
        const float s = distance_of_share(own, static_cast<float>(i) / (shares + 1));
        const double t = own.t0 + static_cast<double>(s);
        const double t_other =
            other_from_own.offset + static_cast<double>(other_from_own.slope) * t;
        const float there = approximate_depth(other, static_cast<float>(t_other - other.t0));
        sum += std::abs(std::exp(-approximate_depth(own, s)) - std::exp(-there));
    }
    return std::exp(-strength * sum / (shares + 1));
}

}  // namespace mote
