#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "restir/cache_stats.h"
#include "restir/coarse_extinction.h"
#include "restir/environment_cache.h"
#include "restir/environment_spots.h"
#include "restir/light_cells.h"
#include "restir/light_guess.h"
#include "restir/local_light.h"
#include "restir/media_key.h"
#include "restir/transmittance_map.h"
#include "scene/scene.h"

namespace mote {

/// What is known beforehand about the light in a frame's media, in parts that exist only if the
/// scene has such lights. Caches shape proposals, targets and control variates: wrong or stale
/// values cost variance, never bias.
struct LightCaches {
    /// A distant light, or a spot of the environment.
    struct Distant {
        int light = -1;  ///< into Scene::lights; -1: a spot
        int spot = -1;   ///< into EnvironmentParts::spots; -1: a light
        Vec3 direction{0.0f};
        Spectrum irradiance{0.0f};
        std::shared_ptr<const TransmittanceMap> map;
    };
    std::vector<Distant> distant;
    std::shared_ptr<const EnvironmentParts> parts;  ///< of the scene's environment: not a guess
    std::optional<EnvironmentCache> environment;    ///< of its rest, without spots
    std::optional<LightCells> cells;                ///< of lamps and emissive volumes
    std::shared_ptr<const CoarseExtinction> extinction;  ///< if asked for
    /// Of each volume; null: does not glow.
    std::vector<std::shared_ptr<const EmissiveBricks>> emissive;

    // What they were made from, to tell whether they may stay.
    MediaKey media;
    std::vector<Volume> volumes;
    std::shared_ptr<const Surfaces> surfaces;
    std::vector<LocalLight> local_lights;
    std::vector<Spectrum> environment_radiance;  ///< mean_radiance()
    std::shared_ptr<const DirectionTransmittance> directions;
    std::shared_ptr<const LightGuess> guess;  ///< goes with `directions`
    int built = 0;                            ///< parts made for this frame
    int reused = 0;                           ///< parts taken over from the frame before
};

/// How fine caches are.
struct CacheSizes {
    /// Pixels times passes that will use the caches: few of them are not worth fine caches.
    int64_t pixel_passes = 1'000'000;
    bool extinction = false;  ///< whether mean extinction is wanted
    bool sky = true;          ///< whether anybody asks for the environment's light
};

/// Caches for a frame. Parts whose media and lights are those of `previous` (may be null) are taken
/// over from it. Cost: nothing without media in view; about 0.1 s for a distant light and an
/// environment around 128 x 256 x 128 voxels of smoke, in parallel.
[[nodiscard]] std::shared_ptr<const LightCaches> make_light_caches(
    const Scene& scene, const CacheSizes& sizes,
    const std::shared_ptr<const LightCaches>& previous);

/// What `caches` are of.
[[nodiscard]] CacheParts parts_of(const LightCaches& caches);

}  // namespace mote
