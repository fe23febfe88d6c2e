#include "multiscatter/walk_path.h"

#include <algorithm>
#include <cmath>

#include "reference/direct_light.h"
#include "reference/path_tracer.h"
#include "reference/visibility.h"
#include "volumes/media_at.h"
#include "volumes/media_extent.h"

namespace mote {
namespace {

/// Mean cosine from which on a lobe counts as narrow.
constexpr float narrow_g = 0.8f;
/// Optical depth between vertices, by the extinction at the second, below which they are close.
constexpr float close_depth = 0.05f;

/// Vertices behind the first belong to one time: nothing but cameras moves while the shutter is
/// open where paths are reused.
constexpr float path_time = cache_time;

Rng numbers_of(const PathWorld& world, const WalkKey& key, Stream stream)
{
    return {world.seed, key.frame, stream, key.pixel, key.walk};
}

/// Albedo times phase function of all media at a point [1/sr].
Spectrum scattered(const Media& media, Vec3 x, Vec3 wo, Vec3 wi)
{
    Spectrum sum(0.0f);
    for_each_scatterer(media, x, path_time,
                       [&](const Volume& volume, float share, Spectrum albedo) {
                           sum += share * eval_phase(volume.phase, wo, wi) * albedo;
                       });
    return sum;
}

bool is_narrow(const MixedPhase& mixture)
{
    return std::any_of(mixture.phases, mixture.phases + mixture.count, [](const Phase* phase) {
        return std::abs(phase->g) > narrow_g ||
               (phase->weight_b > 0.0f && std::abs(phase->g_b) > narrow_g);
    });
}

/// Scatters evenly: for shares of light that do not depend on where an event is seen from.
const Phase even_phase;

ScatterEvent even_event(Vec3 x)
{
    return {x, Vec3(0.0f, 0.0f, 1.0f), path_time, &even_phase};
}

/// From x1 to x2 as one would see it from either: directions drawn are rounded. Where dense smoke
/// is far from the origin, both may be rounded to one place; the direction drawn stays then.
void look_from_first(SecondVertex& v)
{
    const Vec3 way = v.x2 - v.x1;
    v.r = glm::length(way);
    if (v.r > 0.0f) v.w1 = way / v.r;
}

}  // namespace

void make_path_domain(const FrameDomain& frame, const Ray& ray, PixelDomain& domain,
                      BinCounts& counts)
{
    make_pixel_domain(frame, ray, domain, counts);
    const RayBins& bins = domain.bins;
    domain.cdf[0] = 0.0f;
    for (int k = 0; k < bins.count; ++k) {
        domain.cdf[k + 1] =
            domain.cdf[k] + std::exp(-bins.tau[k]) * -std::expm1(-bins.depth_of_bin(k));
    }
}

bool can_reconnect(const MixedPhase& first, const MixedPhase& second, float depth)
{
    return depth > close_depth && !is_narrow(first) && !is_narrow(second);
}

std::optional<SecondVertex> walk_to_second(const PathWorld& world, const PixelDomain& domain,
                                           float u, const WalkKey& key)
{
    const RayPoint point = point_at(world.frame, domain, u);
    if (!(point.weight > 0.0f)) return std::nullopt;
    const Scene& scene = *world.frame.scene;
    const MixedPhase phases = mixed_phase_at(scene.media, point.x, path_time);
    if (phases.empty()) return std::nullopt;
    Rng rng = numbers_of(world, key, Stream::PathPrefix);
    SecondVertex v;
    v.x1 = point.x;
    const float choice = rng.uniform();
    v.w1 = phases.sample(domain.wo(), choice, rng.uniform2());
    const Ray ray{v.x1, v.w1, path_time};
    std::optional<SurfaceHit> hit;
    if (scene.surfaces) hit = intersect(*scene.surfaces, ray, {0.0f, infinity});
    v.collision = sample_free_flight(scene.media, ray, {0.0f, hit ? hit->t : infinity}, rng);
    if (v.collision) {
        v.x2 = ray.at(v.collision->t);
        look_from_first(v);
    } else {
        if (!hit) return std::nullopt;
        v.surface = make_vertex(*scene.surfaces, *hit, path_time);
    }
    v.density = phases.pdf(domain.wo(), v.w1);
    v.carried = point.weight / v.density * scattered(scene.media, v.x1, domain.wo(), v.w1);
    if (!v.collision) return v;
    const MixedPhase there = mixed_phase_at(scene.media, v.x2, path_time);
    if (there.empty()) return std::nullopt;
    const float second_choice = rng.uniform();
    v.wi = there.sample(-v.w1, second_choice, rng.uniform2());
    v.density_wi = there.pdf(-v.w1, v.wi);
    v.reconnects = can_reconnect(phases, there, v.r * sigma_t_at(scene.media, v.x2, path_time));
    return v;
}

void find_light(const PathWorld& world, ReusedPath& path, float& cut)
{
    path.E = Spectrum(0.0f);
    if (path.form == PathForm::ToRay) {
        Rng rng = numbers_of(world, path.key, Stream::PathSuffix);
        const LightRay ray{Ray{path.x2, path.wi, path_time}, inv_4pi, false};
        path.E = trace_scattered_ray(world.trace, ray, 2, Aim{}, rng, cut);
        return;
    }
    Rng rng = numbers_of(world, path.key, Stream::PathLight);
    const ScatterEvent event = even_event(path.x2);
    const std::optional<ShadowRay> ray = sample_shadow_ray(world.trace, event, rng);
    if (!ray) return;
    path.wi = ray->wi;
    path.E = ray->light * estimate_visibility(world.trace, event, ray->wi, ray->distance, rng);
}

Spectrum light_of_second(const PathWorld& world, const SecondVertex& second, const WalkKey& key,
                         float& cut)
{
    ScatterEvent event{second.x2, -second.w1, path_time};
    Spectrum albedo(1.0f);
    if (second.collision) {
        const auto index = static_cast<size_t>(second.collision->volume);
        const Volume& volume = world.media().volumes[index];
        event.phase = &volume.phase;
        albedo = albedo_at(volume, second.collision->p_object);
    } else {
        event.x = second.surface->p;
        event.surface = &*second.surface;
    }
    Rng light_rng = numbers_of(world, key, Stream::PathLight);
    Spectrum light = estimate_direct_light(world.trace, event, light_rng);
    Rng rng = numbers_of(world, key, Stream::PathSuffix);
    const std::optional<ScatteredDirection> s = sample_scattering(event, rng);
    if (s) {
        const Scattering& scattering = s->scattering;
        const LightRay ray{Ray{ray_origin(event, s->wi), s->wi, path_time}, scattering.pdf_dir,
                           false};
        const Spectrum weight = scattering.f / scattering.pdf_dir;
        float cut_behind = 0.0f;
        light += weight * trace_scattered_ray(world.trace, ray, 2, Aim{}, rng, cut_behind);
        cut += max_component(albedo * weight) * cut_behind;
    }
    return albedo * light;
}

void draw_paths(const PathWorld& world, const PixelDomain& domain, float u, const WalkKey& key,
                std::vector<DrawnPath>& paths, float& cut)
{
    const std::optional<SecondVertex> second = walk_to_second(world, domain, u, key);
    if (!second || !(max_component(second->carried) > 0.0f)) return;
    const auto add = [&](const ReusedPath& y, Spectrum value) {
        if (max_component(value) > 0.0f) paths.push_back({y, value});
    };
    ReusedPath y;
    y.u = u;
    y.key = key;
    if (!second->reconnects) {
        float cut_behind = 0.0f;
        add(y, second->carried * light_of_second(world, *second, key, cut_behind));
        cut += max_component(second->carried) * cut_behind;
        return;
    }
    y.x2 = second->x2;
    y.r = second->r;
    const Vec3 wo = -second->w1;
    const auto value = [&](const ReusedPath& path) {
        return second->carried * path.E * scattered(world.media(), path.x2, wo, path.wi);
    };
    float cut_behind = 0.0f;
    y.form = PathForm::ToLight;
    find_light(world, y, cut_behind);
    add(y, value(y));
    y.form = PathForm::ToRay;
    y.wi = second->wi;
    find_light(world, y, cut_behind);
    add(y, value(y) / second->density_wi);
    if (!(cut_behind > 0.0f)) return;
    const Spectrum left = second->carried * scattered(world.media(), y.x2, wo, y.wi);
    cut += max_component(left) / second->density_wi * cut_behind;
}

Spectrum eval_path(const PathWorld& world, const PixelDomain& domain, const ReusedPath& path)
{
    if (path.form == PathForm::Replay) {
        const std::optional<SecondVertex> second = walk_to_second(world, domain, path.u, path.key);
        if (!second || second->reconnects) return Spectrum(0.0f);
        float ignored = 0.0f;
        return second->carried * light_of_second(world, *second, path.key, ignored);
    }
    const RayPoint point = point_at(world.frame, domain, path.u);
    const float sigma_t = sigma_t_at(world.media(), path.x2, path_time);
    if (!(point.weight > 0.0f) || !(sigma_t > 0.0f) || path.E == Spectrum(0.0f)) {
        return Spectrum(0.0f);
    }
    SecondVertex v;
    v.x1 = point.x;
    v.x2 = path.x2;
    look_from_first(v);
    const Scene& scene = *world.frame.scene;
    if (!can_reconnect(mixed_phase_at(scene.media, v.x1, path_time),
                       mixed_phase_at(scene.media, v.x2, path_time), v.r * sigma_t)) {
        return Spectrum(0.0f);
    }
    const Ray ray{v.x1, v.w1, path_time};
    if (scene.surfaces && is_shadowed(*scene.surfaces, ray, v.r)) return Spectrum(0.0f);
    const float T = std::exp(-optical_depth(scene.media, ray, {0.0f, v.r}));
    return point.weight * T * sigma_t * path.E * scattered(scene.media, v.x1, domain.wo(), v.w1) *
           scattered(scene.media, v.x2, -v.w1, path.wi);
}

}  // namespace mote
