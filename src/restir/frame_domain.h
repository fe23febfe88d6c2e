#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "restir/light_caches.h"
#include "scene/restir_params.h"
#include "scene/scene.h"

namespace mote {

/// What a sample's `light` points to.
enum class SampledLightKind { Lamp, Distant, Environment, EmissiveVolume };

struct SampledLight {
    SampledLightKind kind = SampledLightKind::Lamp;
    int index = 0;  ///< into Scene::lights or Media::volumes; 0 for the environment
};

/// Everything outside the pixel that a sample's value depends on, frozen while a pass runs: the
/// media, the lights, the caches. The previous pass's is kept as long as its samples are.
struct FrameDomain {
    std::shared_ptr<const Scene> scene;
    std::shared_ptr<const LightCaches> caches;
    RestirParams params;
    /// Scene::lights in their order, then the emissive volumes, then the environment, if any.
    std::vector<SampledLight> lights;
    bool samples_local = false;  ///< lamps and emissive volumes take part in the candidates
    std::vector<int> infinite;   ///< of `lights`: those at infinity that do so too
    /// Of `lights`: those that phase-function directions look for, see phase_candidates.h.
    std::vector<int> phase_lights;
    bool has_phase_candidates = false;
    bool has_emission = false;        ///< some medium glows
    bool has_motion = false;          ///< camera or media move while the shutter is open
    float transmittance_cut = 1e-7f;  ///< where camera rays may end, see make_ray_bins

    [[nodiscard]] bool has_sampled_lights() const { return samples_local || !infinite.empty(); }
};

/// The domain of a frame. `caches` must be of this scene, or stale: then only noise grows.
[[nodiscard]] FrameDomain make_frame_domain(std::shared_ptr<const Scene> scene,
                                            std::shared_ptr<const LightCaches> caches,
                                            const RestirParams& params);

}  // namespace mote
