#include "restir/frame_domain.h"

#include <algorithm>

#include "restir/phase_candidates.h"

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

}  // namespace

FrameDomain make_frame_domain(std::shared_ptr<const Scene> scene,
                              std::shared_ptr<const LightCaches> caches, const RestirParams& params)
{
    FrameDomain frame;
    frame.params = params;
    frame.transmittance_cut = cut_of(*scene);
    const auto add = [&](SampledLightKind kind, int index, bool infinite) {
        const auto light = static_cast<int>(frame.lights.size());
        frame.lights.push_back({kind, index});
        if (infinite && !params.control_variate) frame.infinite.push_back(light);
    };
    for (size_t i = 0; i < scene->lights.size(); ++i) {
        const bool distant = std::holds_alternative<DistantLight>(scene->lights[i]);
        add(distant ? SampledLightKind::Distant : SampledLightKind::Lamp, static_cast<int>(i),
            distant);
    }
    frame.has_motion = scene->camera.world_from_camera.is_moving();
    for (size_t i = 0; i < scene->media.volumes.size(); ++i) {
        frame.has_motion |= scene->media.volumes[i].world_from_object.is_moving();
        frame.has_emission |= scene->media.volumes[i].emission_params.is_on();
        if (caches->emissive[i]) {
            add(SampledLightKind::EmissiveVolume, static_cast<int>(i), false);
        }
    }
    if (scene->environment) add(SampledLightKind::Environment, 0, true);
    frame.samples_local = caches->cells && !caches->cells->is_empty();
    frame.scene = std::move(scene);
    frame.caches = std::move(caches);
    for (size_t i = 0; i < frame.lights.size(); ++i) {
        const bool sampled =
            frame.lights[i].kind != SampledLightKind::Environment || !params.control_variate;
        if (sampled && is_found_by_phase(frame, static_cast<int>(i))) {
            frame.phase_lights.push_back(static_cast<int>(i));
        }
    }
    frame.has_phase_candidates = !frame.phase_lights.empty();
    return frame;
}

}  // namespace mote
