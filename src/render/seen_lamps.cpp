#include "render/seen_lamps.h"

#include <vector>

namespace mote {
namespace {

/// A lamp, and the rays that met it.
struct SeenLamp {
    int light = -1;
    int count = 0;
    Ray ray;  ///< one of them
    LightHit hit;
};

int strata_of(const PassInputs& inputs, const PassKey& key)
{
    return inputs.split.lamps.size() > 0 ? inputs.split.lamps.at(key.x, key.y) : 1;
}

void add_seen(std::vector<SeenLamp>& seen, int light, const Ray& ray, const LightHit& hit, float u)
{
    size_t i = 0;
    while (i < seen.size() && seen[i].light != light) ++i;
    if (i == seen.size()) seen.push_back({light, 0, {}, {}});
    SeenLamp& lamp = seen[i];
    if (u * static_cast<float>(++lamp.count) < 1.0f) {
        lamp.ray = ray;
        lamp.hit = hit;
    }
}

}  // namespace

bool has_lamp_rays(const PassInputs& inputs, const PassKey& key)
{
    return strata_of(inputs, key) > 1;
}

void look_for_lamps(const PassInputs& inputs, const PassKey& key, int owner, float weight,
                    LightRays& rays)
{
    const int strata = strata_of(inputs, key);
    if (strata < 2) return;
    const Scene& scene = *inputs.domain.scene;
    Rng rng = pass_rng(inputs, key, Stream::SeenLamps);
    std::vector<SeenLamp> seen;
    for (int i = 0; i < strata * strata; ++i) {
        const Ray ray = stratum_ray(inputs, key, i % strata, i / strata, strata, rng);
        inputs.domain.lamp_surfaces->for_each_on_ray(ray, [&](int light) {
            const std::optional<LightHit> hit =
                hit_light(scene.lights[static_cast<size_t>(light)], ray.o, ray.d);
            if (!hit) return;
            if (scene.surfaces && is_shadowed(*scene.surfaces, ray, hit->distance)) return;
            add_seen(seen, light, ray, *hit, rng.uniform());
        });
    }
    const float share = weight / static_cast<float>(strata * strata);
    for (const SeenLamp& lamp : seen) {
        rays.add(owner, lamp.ray.o, lamp.ray.d, lamp.hit.distance, lamp.ray.time,
                 share * static_cast<float>(lamp.count) * lamp.hit.Le, infinity);
    }
}

}  // namespace mote
