#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "restir/light_caches.h"
#include "scene/lamp_surfaces.h"
#include "scene/restir_params.h"
#include "scene/scene.h"

namespace mote {

/// What a sample's `light` points to.
enum class SampledLightKind { Lamp, Distant, Environment, EmissiveVolume };

struct SampledLight {
    SampledLightKind kind = SampledLightKind::Lamp;
    int index = 0;  ///< into Scene::lights or Media::volumes; 0 for the environment
};

/// Which lights are also looked for by directions drawn from a phase function or a BSDF. What is
/// not, is found by its own sampling alone.
struct DirectionTargets {
    bool environment = false;
    bool quads = false;
    bool spheres = false;
    bool triangles = false;  ///< of emissive surfaces
    bool emissive_volumes = false;

    [[nodiscard]] bool any() const
    {
        return environment || quads || spheres || triangles || emissive_volumes;
    }
};

/// Everything outside the pixel that a sample's value depends on, frozen while a pass runs: the
/// media, the lights, the caches. The previous pass's is kept as long as its samples are.
struct FrameDomain {
    std::shared_ptr<const Scene> scene;
    std::shared_ptr<const LightCaches> caches;
    RestirParams params;
    /// Scene::lights in their order, then the emissive volumes, then the environment, if any.
    std::vector<SampledLight> lights;
    bool samples_local = false;    ///< lamps and emissive volumes take part in the candidates
    std::vector<int> at_infinity;  ///< of `lights`
    std::vector<int> infinite;     ///< those of them that do so too
    std::shared_ptr<const LampSurfaces> lamp_surfaces;
    DirectionTargets phase_finds;  ///< what directions from phase functions look for
    DirectionTargets bsdf_finds;   ///< and those from surfaces
    bool has_emission = false;     ///< some medium glows
    bool has_motion = false;       ///< anything moves while the shutter is open
    /// Luminance of light known to come from distant lights and from the environment, the mean over
    /// pixels in smoke; 0: unknown, every pixel gets the same number of corrections.
    Vec2 mean_known{0.0f};
    float transmittance_cut = 1e-7f;  ///< where camera rays may end, see make_ray_bins

    [[nodiscard]] bool has_sampled_lights() const { return samples_local || !infinite.empty(); }
};

/// The domain of a frame. `caches` must be of this scene, or stale: then only noise grows. What
/// depends on lights that are still those of `before` (may be null, or empty) is taken from there.
[[nodiscard]] FrameDomain make_frame_domain(std::shared_ptr<const Scene> scene,
                                            std::shared_ptr<const LightCaches> caches,
                                            const RestirParams& params,
                                            const FrameDomain* before = nullptr);

}  // namespace mote
