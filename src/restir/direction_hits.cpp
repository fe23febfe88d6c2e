#include "restir/direction_hits.h"

#include <algorithm>

#include "scene/environment.h"
#include "volumes/emissive_line.h"

namespace mote {
namespace {

/// The numbers for which sample_light returns a triangle's point of these barycentric coordinates.
Vec2 numbers_of_triangle(float u, float v)
{
    const float root = u + v;
    return {sqr(root), root > 0.0f ? v / root : 0.0f};
}

/// Whether an object that does not move is mirrored: its lights' edges are then the triangles' in
/// the other order (see world_triangle).
bool is_mirrored_at_rest(const Surfaces& surfaces, int object)
{
    const Vec3d scale =
        surfaces.bvh->instances()[static_cast<size_t>(object)].world_from_object.keys.front().scale;
    return scale.x * scale.y * scale.z < 0.0;
}

bool looks_for(const DirectionTargets& finds, const Light& lamp)
{
    return (finds.quads && std::holds_alternative<QuadLight>(lamp)) ||
           (finds.spheres && std::holds_alternative<SphereLight>(lamp)) ||
           (finds.triangles && std::holds_alternative<TriangleLight>(lamp));
}

/// Hands the hits of one ray on.
struct Reporter {
    const FrameDomain& frame;
    const DirectionTargets& finds;
    const Ray& ray;
    const std::function<void(const DirectionHit&)>& f;

    void operator()(int light, Vec3 v, float light_density) const
    {
        const PathSample y{0.0f, light, v};
        const std::optional<Arrival> arrival = light_at(frame, y, ray.o, ray.time);
        if (!arrival) return;
        DirectionHit hit{light, v, *arrival, light_density, 0.0f};
        hit.per_direction = density_per_direction(frame, finds, ray.o, ray.time, y, *arrival);
        if (hit.per_direction > 0.0f) f(hit);
    }
    void lamp(int light, Vec2 numbers) const
    {
        const Vec2 inside = glm::clamp(numbers, Vec2(0.0f), Vec2(one_minus_epsilon));
        (*this)(light, Vec3(inside.x, inside.y, 0.0f), 1.0f);
    }
    void lamps() const
    {
        const Scene& scene = *frame.scene;
        frame.lamp_surfaces->for_each_on_ray(ray, [&](int light) {
            const Light& found = scene.lights[static_cast<size_t>(light)];
            if (!looks_for(finds, found)) return;
            const std::optional<Vec2> u = light_numbers(found, ray.o, ray.d);
            if (u) lamp(light, *u);
        });
    }
    void triangle() const
    {
        const Scene& scene = *frame.scene;
        const auto hit = intersect(*scene.surfaces, ray, {0.0f, infinity});
        if (!hit) return;
        const int first = scene.first_light_of_object[static_cast<size_t>(hit->object)];
        if (first < 0) return;
        const bool is_mirrored = is_mirrored_at_rest(*scene.surfaces, hit->object);
        lamp(first + hit->triangle, is_mirrored ? numbers_of_triangle(hit->v, hit->u)
                                                : numbers_of_triangle(hit->u, hit->v));
    }
    void emissive_volume(int light, float u) const
    {
        const auto i = static_cast<size_t>(frame.lights[static_cast<size_t>(light)].index);
        const Volume& volume = frame.scene->media.volumes[i];
        const EmissiveBricks& bricks = *frame.caches->emissive[i];
        const std::optional<LineSample> sample = sample_emissive_line(volume, bricks, ray, u);
        if (!sample) return;
        const Vec3 p = ray.at(sample->t);
        (*this)(light, p,
                emission_pdf(volume, bricks, ray.time, object_point(volume, p, ray.time)));
    }
};

}  // namespace

float density_per_direction(const FrameDomain& frame, const DirectionTargets& finds, Vec3 x,
                            float time, const PathSample& y, const Arrival& arrival)
{
    const SampledLight& light = frame.lights[static_cast<size_t>(y.light)];
    const auto i = static_cast<size_t>(light.index);
    switch (light.kind) {
        case SampledLightKind::Distant:
            return 0.0f;
        case SampledLightKind::Environment:
            return finds.environment ? 1.0f : 0.0f;
        case SampledLightKind::EmissiveVolume: {
            if (!finds.emissive_volumes) return 0.0f;
            const float pdf =
                emissive_line_pdf(frame.scene->media.volumes[i], *frame.caches->emissive[i],
                                  {x, arrival.wi, time}, arrival.distance);
            const float density = pdf / sqr(arrival.distance);
            return density < infinity ? density : 0.0f;
        }
        case SampledLightKind::Lamp: {
            const Light& lamp = frame.scene->lights[i];
            if (!looks_for(finds, lamp)) return 0.0f;
            const float pdf_dir = light_pdf(lamp, x, arrival.wi);
            return pdf_dir > 0.0f ? 1.0f / pdf_dir : 0.0f;
        }
    }
    return 0.0f;
}

void for_each_light_along(const FrameDomain& frame, const DirectionTargets& finds, const Ray& ray,
                          float u, const std::function<void(const DirectionHit&)>& f)
{
    const Reporter report{frame, finds, ray, f};
    if (finds.quads || finds.spheres) report.lamps();
    if (finds.triangles) report.triangle();
    const auto first = frame.scene->lights.size();
    for (size_t i = first; i < frame.lights.size(); ++i) {
        const auto light = static_cast<int>(i);
        const bool is_volume = frame.lights[i].kind == SampledLightKind::EmissiveVolume;
        if (is_volume && finds.emissive_volumes) report.emissive_volume(light, u);
        if (!is_volume && finds.environment) {
            report(light, ray.d, environment_pdf(*frame.scene->environment, ray.d));
        }
    }
}

}  // namespace mote
