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

/// Whether the pixel's list tells where to look for a lamp.
bool is_listed(const PassInputs& inputs, const PassKey& key, int light)
{
    const LampLists& lists = inputs.split.lists;
    return !lists.at(key.x, key.y).empty() && !lists.boxes[static_cast<size_t>(light)].is_empty();
}

/// Calls f(ray) for a camera ray through each stratum of a part of the film.
template <class F>
void for_each_stratum(const PassInputs& inputs, const FilmBox& part, Rng& rng, F&& f)
{
    const int strata = inputs.domain.params.edge_strata;
    const Vec2 size = part.extent() / static_cast<float>(strata);
    for (int i = 0; i < strata * strata; ++i) {
        f(ray_within(inputs, part.lo + Vec2(i % strata, i / strata) * size, size, rng));
    }
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

bool has_lamp_rays(const PassInputs& inputs, const PassKey& key, int light)
{
    return strata_of(inputs, key) > 1 || is_listed(inputs, key, light);
}

void look_for_lamps(const PassInputs& inputs, const PassKey& key, int owner, float weight,
                    LightRays& rays)
{
    const Scene& scene = *inputs.domain.scene;
    const bool looks_all_over = strata_of(inputs, key) > 1;
    const std::span<const uint32_t> listed = inputs.split.lists.at(key.x, key.y);
    if (!looks_all_over && listed.empty()) return;
    Rng rng = pass_rng(inputs, key, Stream::SeenLamps);
    std::vector<SeenLamp> seen;
    const auto look = [&](int light, const Ray& ray) {
        const std::optional<LightHit> hit =
            hit_light(scene.lights[static_cast<size_t>(light)], ray.o, ray.d);
        if (!hit) return;
        if (scene.surfaces && is_shadowed(*scene.surfaces, ray, hit->distance)) return;
        add_seen(seen, light, ray, *hit, rng.uniform());
    };
    const auto ask = [&](float area) {
        for (const SeenLamp& lamp : seen) {
            rays.add(owner, lamp.ray.o, lamp.ray.d, lamp.hit.distance, lamp.ray.time,
                     weight * area * static_cast<float>(lamp.count) * lamp.hit.Le, infinity);
        }
        seen.clear();
    };
    const Vec2 corner(key.x, key.y);
    const int strata = inputs.domain.params.edge_strata;
    const auto strata_share = 1.0f / static_cast<float>(strata * strata);
    if (looks_all_over) {
        for_each_stratum(inputs, {corner, corner + 1.0f}, rng, [&](const Ray& ray) {
            inputs.domain.lamp_surfaces->for_each_on_ray(ray, [&](int light) {
                if (!is_listed(inputs, key, light)) look(light, ray);
            });
        });
        ask(strata_share);
    }
    for (const uint32_t light : listed) {
        const FilmBox& box = inputs.split.lists.boxes[light];
        const FilmBox part{glm::max(box.lo, corner), glm::min(box.hi, corner + 1.0f)};
        if (part.is_empty()) continue;
        for_each_stratum(inputs, part, rng,
                         [&](const Ray& ray) { look(static_cast<int>(light), ray); });
        ask(strata_share * part.extent().x * part.extent().y);
    }
}

}  // namespace mote
