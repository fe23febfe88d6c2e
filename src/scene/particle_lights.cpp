#include "scene/particle_lights.h"

#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "particles/source.h"
#include "scene/particle_system.h"
#include "scene/prepare_lights.h"
#include "volumes/blackbody.h"

namespace mote {
namespace {

/// Radiance of a black body over that of one at 1500 K whose luminance is 1.
Spectrum glow(float temperature)
{
    if (!(temperature > 0.0f)) return Spectrum(0.0f);
    const float ratio = temperature / 1500.0f;
    return ratio * ratio * ratio * ratio * blackbody_rgb(temperature);
}

ParticleSet particles_of(const SceneDescription& description, const LightDescription& light,
                         const ParticlesDescription& system, double frame)
{
    AttributeMask mask{};
    mask.velocity = frame != std::floor(frame);  // caches move their particles by it
    mask.temperature = light.use_temperature;
    mask.color = light.use_color;
    mask.id = mask.age = false;
    ParticleSet set =
        particles_at(system.source, frame, description.fps, description.base_dir, mask);
    if (set.size() == 0) return set;
    if (light.use_temperature && set.temperature.empty()) {
        missing_attribute(system, "temperature", "\"use_temperature\"");
    }
    if (light.use_color && set.color.empty()) missing_attribute(system, "color", "\"use_color\"");
    if (set.size() > max_particle_lights) {
        throw Error(ExitCode::Input,
                    fmt::format("particles \"{}\": {} of them are more than the {} lamps that a "
                                "light may be; show fewer, or let a volume glow instead",
                                system.name, set.size(), max_particle_lights));
    }
    return set;
}

void add_lamps(const ParticleSet& set, const LightDescription& light, double frame,
               std::vector<Light>& lights)
{
    const Trs trs = evaluate(light.transform, frame);
    const Affine world_from_object = to_affine(matrix(trs));
    const Vec3 scale = glm::abs(Vec3(trs.scale));
    const Spectrum brightness = brightness_at(light, frame);
    const float radius_scale = light.radius_scale * (scale.x + scale.y + scale.z) / 3.0f;
    for (size_t i = 0; i < set.size(); ++i) {
        Spectrum radiance = brightness;
        if (light.use_color) radiance *= set.color[i];
        if (light.use_temperature) radiance *= glow(set.temperature[i]);
        const float radius = radius_scale * set.radius[i];
        const bool shines = max_component(radiance) > 0.0f && radius > 0.0f;
        if (!shines || !is_finite(radiance) || !std::isfinite(radius)) continue;
        lights.push_back(SphereLight{world_from_object.point(set.position[i]), radius, radiance});
    }
}

}  // namespace

void add_particle_lights(const SceneDescription& description, double frame, PrepareStats& stats,
                         std::vector<Light>& lights)
{
    for (const LightDescription& light : description.lights) {
        if (light.particles.empty()) continue;
        if (!(max_component(brightness_at(light, frame)) > 0.0f)) continue;
        const auto start = std::chrono::steady_clock::now();
        const ParticlesDescription& system = find_system(description, light.particles);
        const ParticleSet set = particles_of(description, light, system, frame);
        stats.particles += static_cast<int64_t>(set.size());
        add_lamps(set, light, frame, lights);
        const auto now = std::chrono::steady_clock::now();
        stats.particle_seconds += std::chrono::duration<double>(now - start).count();
    }
}

}  // namespace mote
