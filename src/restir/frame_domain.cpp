#include "restir/frame_domain.h"

#include <algorithm>

#include "restir/same.h"

namespace mote {
namespace {

/// Contributions below this share of the pixel do not count. What glows may outshine the rest by
/// orders of magnitude, so there rays go on for longer.
float cut_of(const Scene& scene)
{
    for (const Volume& volume : scene.media.volumes) {
        if (volume.emission_params.is_on()) return 1e-20f;
    }
    const bool local = std::any_of(scene.lights.begin(), scene.lights.end(), [](const Light& l) {
        return !std::holds_alternative<DistantLight>(l);
    });
    return local ? 1e-12f : 1e-8f;
}

/// Lobes narrower than this often meet spheres that light sampling finds at the lobe's edge.
constexpr float narrow_g = 0.7f;

bool has_narrow_lobes(const Media& media)
{
    return std::any_of(media.volumes.begin(), media.volumes.end(), [](const Volume& volume) {
        const Phase& phase = volume.phase;
        return std::abs(phase.g) > narrow_g ||
               (phase.weight_b > 0.0f && std::abs(phase.g_b) > narrow_g);
    });
}

/// All that the scene has. Light sampling is unbounded close to quads and triangles and inside
/// emissive volumes, so these are always looked for.
DirectionTargets targets_of(const Scene& scene, const LightCaches& caches)
{
    DirectionTargets out;
    out.environment = scene.environment.has_value();
    for (const Light& light : scene.lights) {
        out.quads |= std::holds_alternative<QuadLight>(light);
        out.spheres |= std::holds_alternative<SphereLight>(light);
        out.triangles |= scene.surfaces && std::holds_alternative<TriangleLight>(light);
    }
    for (const auto& bricks : caches.emissive) out.emissive_volumes |= bricks != nullptr;
    return out;
}

}  // namespace

FrameDomain make_frame_domain(std::shared_ptr<const Scene> scene,
                              std::shared_ptr<const LightCaches> caches, const RestirParams& params,
                              const FrameDomain* before)
{
    FrameDomain frame;
    frame.params = params;
    frame.transmittance_cut = cut_of(*scene);
    const auto add = [&](SampledLightKind kind, int index, bool infinite) {
        const auto light = static_cast<int>(frame.lights.size());
        frame.lights.push_back({kind, index});
        if (infinite) frame.at_infinity.push_back(light);
    };
    for (size_t i = 0; i < scene->lights.size(); ++i) {
        const bool distant = std::holds_alternative<DistantLight>(scene->lights[i]);
        add(distant ? SampledLightKind::Distant : SampledLightKind::Lamp, static_cast<int>(i),
            distant);
    }
    frame.has_motion = scene->camera.world_from_camera.is_moving();
    if (scene->surfaces) {
        for (const MeshInstance& instance : scene->surfaces->bvh->instances()) {
            frame.has_motion |= instance.world_from_object.is_moving();
        }
    }
    for (size_t i = 0; i < scene->media.volumes.size(); ++i) {
        frame.has_motion |= scene->media.volumes[i].world_from_object.is_moving();
        frame.has_emission |= scene->media.volumes[i].emission_params.is_on();
        if (caches->emissive[i]) {
            add(SampledLightKind::EmissiveVolume, static_cast<int>(i), false);
        }
    }
    if (scene->environment) add(SampledLightKind::Environment, 0, true);
    if (!params.control_variate) frame.infinite = frame.at_infinity;
    frame.samples_local = caches->cells && !caches->cells->is_empty();
    frame.scene = std::move(scene);
    frame.caches = std::move(caches);
    const bool same_lamps =
        before && before->scene && have_same_lamps(before->scene->lights, frame.scene->lights);
    frame.lamp_surfaces = same_lamps ? before->lamp_surfaces
                                     : std::make_shared<const LampSurfaces>(frame.scene->lights);
    frame.bsdf_finds = targets_of(*frame.scene, *frame.caches);
    frame.phase_finds = frame.bsdf_finds;
    frame.phase_finds.environment &= !params.control_variate;
    frame.phase_finds.spheres &= has_narrow_lobes(frame.scene->media);
    return frame;
}

}  // namespace mote
