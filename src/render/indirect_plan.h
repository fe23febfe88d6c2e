#pragma once

#include <optional>

#include "multiscatter/radiance_cache.h"
#include "multiscatter/scatter_nodes.h"
#include "multiscatter/shared_paths.h"
#include "reference/aimed_light.h"
#include "restir/light_caches.h"
#include "scene/description.h"

namespace mote {

/// Whether a frame's pixels share paths of many events; its light caches then need mean extinction.
[[nodiscard]] bool shares_paths(const Scene& scene, const RenderDescription& render);

/// Whether a constant environment is the only light of the scene, and paths go on until they find
/// it. Then what a path brings hardly depends on when it does, and parts of its light vary far more
/// than their sum: light scattered once is best left to the same paths. (Measured: puff_sky, 480 x
/// 270, 2.8 times as efficient.) Needs no light caches.
[[nodiscard]] bool paths_bring_sky(const Scene& scene, const RenderDescription& render);

/// The same of surfaces, where the sky's light can be told from that of lamps: whatever else
/// shines.
[[nodiscard]] bool surface_paths_bring_sky(const Scene& scene, const RenderDescription& render);

/// Whether residual walks from a frame's pixels correct a cache of radiance.
[[nodiscard]] bool corrects_cache(const Scene& scene, const RenderDescription& render);

/// What a frame has for light of many events before its first pass; what it does without is empty.
struct IndirectGuesses {
    std::optional<ScatterNodes> nodes;      ///< of previews
    std::optional<RadianceCache> radiance;  ///< for residual walks
    std::optional<PathSharing> sharing;     ///< of paths; see point_to_mean
    std::optional<MeanRadiance> mean;       ///< where paths are shared and it serves them
    bool leaves_mean_out = false;  ///< of what is shared: not around small lamps nor where walks
                                   ///< are cut short
    double cpu_seconds = 0.0;
};

/// What the frame takes its guesses from.
struct IndirectInputs {
    const Scene& scene;
    const RenderDescription& render;
    const LightSampler& lights;
    const LightCaches& caches;
    const AimedLights& aims;
    bool reuses_paths = false;
    const MeanRadiance* before = nullptr;  ///< of the frames before, if this one reuses them
    bool is_same = false;                  ///< but for the camera nothing has changed since
};

/// Cost: previews' nodes; a tenth of the frame's paths for residual walks, a fiftieth of them for
/// the mean radiance, in both cases of as many as there would be if all tiles that see media were
/// full of them.
[[nodiscard]] IndirectGuesses guess_indirect(const IndirectInputs& inputs);

/// Lets `sharing` use the mean radiance, where the guesses stay.
void point_to_mean(const RestirParams& params, IndirectGuesses& guesses);

}  // namespace mote
