#include "render/camera_pass.h"

#include "render/indirect_pass.h"
#include "render/motion.h"
#include "render/seen_lamps.h"
#include "render/view_depth.h"
#include "restir/emission_along.h"
#include "scene/environment.h"
#include "surfaces/bsdf.h"
#include "volumes/media_at.h"

namespace mote {
namespace {

/// Passes are fewer than 2^24.
constexpr uint32_t first_part_bit = 24;

uint32_t pixel_index(const Camera& camera, const PassKey& key)
{
    return static_cast<uint32_t>(key.y * camera.width + key.x);
}

PassSequence pass_numbers(const PassInputs& inputs, const PassKey& key)
{
    const Scene& scene = *inputs.domain.scene;
    const uint32_t frame_key =
        hash_combine(hash_combine(hash32(inputs.render.seed), static_cast<uint32_t>(scene.frame)),
                     static_cast<uint32_t>(Stream::Camera));
    const uint32_t pixel_key = hash_combine(frame_key, pixel_index(scene.camera, key));
    return {key.part == 0 ? pixel_key : hash_combine(pixel_key, key.part), key.pass};
}

Vec2 pair(const PassSequence& numbers, NumberPair which)
{
    return numbers.pair(static_cast<uint32_t>(which));
}

/// Transmittance from the camera to a world distance.
float transmittance_to(const FrameDomain& frame, const PixelDomain& domain, float t)
{
    const auto s = static_cast<float>(static_cast<double>(t) - domain.bins.t0);
    return std::exp(-depth_to(frame.scene->media, domain.ray, domain.bins, s));
}

Spectrum seen_background(const PassInputs& inputs, const PassKey& key, const PixelDomain& domain,
                         float transmittance)
{
    const Scene& scene = *inputs.domain.scene;
    Spectrum sum(0.0f);
    if (scene.environment && !domain.surface) {
        sum += transmittance * environment_radiance(*scene.environment, domain.ray.d);
    }
    inputs.domain.lamp_surfaces->for_each_on_ray(domain.ray, [&](int index) {
        if (has_lamp_rays(inputs, key, index)) return;
        const Light& light = scene.lights[static_cast<size_t>(index)];
        const std::optional<LightHit> hit = hit_light(light, domain.ray.o, domain.ray.d);
        if (hit && clear_distance(hit->distance) <= domain.t_end()) {
            sum += transmittance_to(inputs.domain, domain, hit->distance) * hit->Le;
        }
    });
    return sum;
}

/// The layers that belong to a first collision, in a medium or with the surface behind it: one
/// exact free flight stands for them.
void add_first_collision(const PassInputs& inputs, const PixelDomain& domain,
                         const SurfaceVertex* surface, float u, FilmSample& sample)
{
    const Scene& scene = *inputs.domain.scene;
    const AovSet& aovs = inputs.aovs;
    const float depth = domain.bins.depth();
    const float tau = -std::log1p(-u);
    const bool in_medium = tau < depth;
    sample.collided = in_medium || surface;
    sample.on_surface = !in_medium && surface;
    float t = domain.t_end();
    if (sample.on_surface) {
        sample.depth = view_depth(scene.camera, domain.ray, t);
        sample.albedo = surface_albedo(*surface);
    } else if (in_medium) {
        t = domain.bins.world_t(distance_at(scene.media, domain.ray, domain.bins, tau));
        sample.depth = view_depth(scene.camera, domain.ray, t);
        for_each_scatterer(scene.media, domain.ray.at(t), domain.ray.time,
                           [&](const Volume& /*volume*/, float share, Spectrum albedo) {
                               sample.albedo += share * albedo;
                           });
    }
    const int object = sample.on_surface ? surface->object : -1;
    if (aovs.needs_motion()) sample.motion = film_motion(scene, domain.ray, t, object);
}

/// Of what ends the ray: its emission, normal and place, and the domain of its samples.
void begin_surface(const PassInputs& inputs, const PassKey& key, const PixelDomain& media,
                   SurfaceDomain& domain, FilmSample& sample)
{
    domain = {};
    if (!media.surface) return;
    Rng rng = pass_rng(inputs, key, Stream::Surface);
    domain = make_surface_domain(inputs.domain, media, rng.uniform());
    const SurfaceVertex& v = domain.v;
    sample.surface_emission = sample.transmittance * surface_emission(v, domain.wo);
    sample.transmittance = 0.0f;
    sample.has_surface = true;
    sample.normal = glm::dot(v.ng, domain.wo) > 0.0f ? v.ns : -v.ns;
    sample.position = v.p;
    sample.surface_distance = domain.distance;
    sample.material = inputs.domain.scene->surfaces->material_index(v.object);
}

}  // namespace

void PassCounts::add(const PassCounts& other)
{
    bins.rays += other.bins.rays;
    bins.misses += other.bins.misses;
    bins.uniform_bricks += other.bins.uniform_bricks;
    bins.cells += other.bins.cells;
    bins.bins += other.bins.bins;
    light_rays.add(other.light_rays);
    guesses.add(other.guesses);
    lamps.add(other.lamps);
    reuse.histories += other.reuse.histories;
    reuse.neighbours += other.reuse.neighbours;
    candidates += other.candidates;
    surfaces += other.surfaces;
    emission_integrals += other.emission_integrals;
    truncation.add(other.truncation);
    tracking.add(other.tracking);
}

Rng pass_rng(const PassInputs& inputs, const PassKey& key, Stream stream)
{
    const Scene& scene = *inputs.domain.scene;
    return {inputs.render.seed, static_cast<uint32_t>(scene.frame), stream,
            pixel_index(scene.camera, key), key.pass | key.part << first_part_bit};
}

Vec2 camera_film(const PassInputs& inputs, const PassKey& key)
{
    return Vec2(key.x, key.y) + pair(pass_numbers(inputs, key), NumberPair::Film);
}

Ray camera_ray(const PassInputs& inputs, const PassKey& key)
{
    const PassSequence numbers = pass_numbers(inputs, key);
    const Camera& camera = inputs.domain.scene->camera;
    const Vec2 film = camera_film(inputs, key);
    const Vec2 lens = camera.lens_radius > 0.0f ? pair(numbers, NumberPair::Lens) : Vec2(0.5f);
    const bool moves = inputs.domain.has_motion;
    return generate_ray(camera, film, lens, moves ? pair(numbers, NumberPair::Time).x : 0.0f);
}

Ray stratum_ray(const PassInputs& inputs, const PassKey& key, int sx, int sy, int strata, Rng& rng)
{
    const float size = 1.0f / static_cast<float>(strata);
    return ray_within(inputs, Vec2(key.x, key.y) + size * Vec2(sx, sy), Vec2(size), rng);
}

Ray ray_within(const PassInputs& inputs, Vec2 corner, Vec2 size, Rng& rng)
{
    const Camera& camera = inputs.domain.scene->camera;
    const Vec2 film = corner + size * rng.uniform2();
    const Vec2 lens = camera.lens_radius > 0.0f ? rng.uniform2() : Vec2(0.5f);
    return generate_ray(camera, film, lens, inputs.domain.has_motion ? rng.uniform() : 0.0f);
}

std::optional<FilmSample> uniform_tile(const PassInputs& inputs, const Tile& tile)
{
    const Scene& scene = *inputs.domain.scene;
    const bool varies = (scene.environment && scene.environment->map) ||
                        !inputs.domain.lamp_surfaces->is_empty() || inputs.aovs.needs_motion();
    if (varies || media_in_view(scene, tile) || surfaces_in_view(scene, tile)) return std::nullopt;
    FilmSample sample;
    if (scene.environment) sample.background = scene.environment->radiance;
    return sample;
}

void begin_pass(const PassInputs& inputs, const PassKey& key, const PixelDomain& media, int owner,
                SurfaceDomain& surface_domain, TileRays& rays, std::vector<PathVertex>& first,
                FilmSample& sample, PassCounts& counts)
{
    const FrameDomain& frame = inputs.domain;
    const Scene& scene = *frame.scene;
    const Ray& ray = media.ray;
    const PassSequence numbers = pass_numbers(inputs, key);

    sample.optical_depth = media.bins.depth();
    sample.transmittance = std::exp(-sample.optical_depth);
    sample.exact_rays = media.bins.empty() ? 0.0f : 1.0f;
    sample.work.y = static_cast<float>(media.bins.cells);
    if (inputs.aovs.has(Aov::OpticalDepth) && sample.transmittance <= frame.transmittance_cut) {
        // The bins may end before the media do.
        sample.optical_depth = optical_depth(scene.media, ray, {0.0f, media.t_end()});
    }
    sample.background = seen_background(inputs, key, media, sample.transmittance);
    if (frame.has_emission) {
        Rng rng = pass_rng(inputs, key, Stream::Shade);
        sample.emission = emission_along(frame, media, rng);
        ++counts.emission_integrals;
    }
    begin_surface(inputs, key, media, surface_domain, sample);
    const SurfaceVertex* surface = media.surface ? &surface_domain.v : nullptr;
    const bool is_empty = media.bins.empty() && !surface;
    if (is_empty && !inputs.aovs.needs_motion()) return;
    if (inputs.aovs.needs_first_collision()) {
        add_first_collision(inputs, media, surface, pair(numbers, NumberPair::Flight).x, sample);
    }
    const int max_bounces = inputs.render.path.max_bounces;
    if (is_empty || max_bounces == 0) return;
    const CorrectionPairs pairs{
        static_cast<uint32_t>(NumberPair::Distances), static_cast<uint32_t>(NumberPair::Directions),
        static_cast<uint32_t>(NumberPair::Choices), static_cast<uint32_t>(NumberPair::Guesses),
        static_cast<uint32_t>(NumberPair::Counts)};
    if (frame.params.control_variate && !inputs.paths_bring_sky) {
        Rng rng = pass_rng(inputs, key, Stream::Path);
        sample.direct =
            scatter_infinite_lights(frame, ray, media.bins, numbers, pairs, rng, owner, rays);
    }
    add_indirect(inputs, key, media, surface, owner, first, sample, counts);
}

}  // namespace mote
