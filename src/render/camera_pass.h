#pragma once

#include "core/sobol.h"
#include "multiscatter/path_vertex.h"
#include "multiscatter/radiance_cache.h"
#include "multiscatter/scatter_nodes.h"
#include "multiscatter/shared_paths.h"
#include "render/aov.h"
#include "render/film.h"
#include "render/pixel_split.h"
#include "render/truncation.h"
#include "restir/control_variate.h"
#include "restir/in_view.h"
#include "restir/pixel_domain.h"
#include "restir/reuse_passes.h"
#include "restir/surface_domain.h"
#include "scene/description.h"
#include "volumes/tracking_counts.h"

namespace mote {

/// Pairs of a pixel's PassSequence.
enum class NumberPair : uint32_t {
    Film,
    Lens,
    Time,
    Distances,
    Directions,
    Choices,
    Flight,
    Guesses,
    Counts
};

/// What every pass of the ReSTIR estimator reads.
struct PassInputs {
    const FrameDomain& domain;
    const RenderDescription& render;
    AovSet aovs;
    const LightSampler& lights;            ///< for paths of many events; empty if there are none
    const ScatterNodes* nodes = nullptr;   ///< for previews; null: none
    const PathSharing* sharing = nullptr;  ///< of paths of many events; null: none are shared
    bool paths_bring_sky = false;          ///< see paths_bring_sky()
    bool surface_paths_bring_sky = false;
    Buffer2D<Spectrum>* path_light = nullptr;  ///< of reused paths, by pass; null: none are reused
    AimedLights aims{};                        ///< of paths of many events
    PixelSplits split{};                       ///< where pixels take several camera rays
    const RadianceCache* radiance = nullptr;   ///< for residual walks; null: plain paths
};

/// One pixel's pass: where, and which.
struct PassKey {
    int x = 0;
    int y = 0;
    uint32_t pass = 0;  ///< counts from 0 within the frame
    uint32_t part = 0;  ///< of the pixel's pass, see split_pixel
};

/// Counts of work, for statistics.
struct PassCounts {
    BinCounts bins;
    WalkCounts light_rays;
    WalkCounts guesses;  ///< rays towards lights through coarse media
    WalkCounts lamps;    ///< camera rays to lamps in view
    ReuseCounts reuse;
    int64_t candidates = 0;          ///< in media and on surfaces
    int64_t surfaces = 0;            ///< passes that sampled a surface's light
    int64_t emission_integrals = 0;  ///< along camera rays, over all media that glow
    Truncation truncation;           ///< of passes
    TrackingCounts tracking;         ///< of the path tracer's part

    void add(const PassCounts& other);
};

/// Place on the film of the pixel's camera ray in a pass [px].
[[nodiscard]] Vec2 camera_film(const PassInputs& inputs, const PassKey& key);

/// That ray: place on the film, on the lens and in time.
[[nodiscard]] Ray camera_ray(const PassInputs& inputs, const PassKey& key);

/// A ray through a part of the film, from its low corner on.
[[nodiscard]] Ray ray_within(const PassInputs& inputs, Vec2 corner, Vec2 size, Rng& rng);

/// A ray of the same pixel through one stratum of `strata` a side.
[[nodiscard]] Ray stratum_ray(const PassInputs& inputs, const PassKey& key, int sx, int sy,
                              int strata, Rng& rng);

/// From the media along the pixel's camera ray, up to a surface, makes the domain of that surface's
/// samples and fills all parts of the sample that need no reservoir: background and alpha in closed
/// form, emission by one point per brick with exact transmittance, lights at infinity by control
/// variate (corrections go to `rays` under `owner`), two and more events. Pixels without smoke cost
/// a bounds test. Where paths are shared (shares_paths), events in media are put to `first` for
/// light_shared_paths.
void begin_pass(const PassInputs& inputs, const PassKey& key, const PixelDomain& media, int owner,
                SurfaceDomain& surface, TileRays& rays, std::vector<PathVertex>& first,
                FilmSample& sample, PassCounts& counts);

/// What every pass of every pixel of a tile shows, if that is one and the same: a constant
/// background, or none, and no medium or surface that a ray of the tile may meet.
[[nodiscard]] std::optional<FilmSample> uniform_tile(const PassInputs& inputs, const Tile& tile);

/// The random numbers of one purpose in a part of a pixel's pass.
[[nodiscard]] Rng pass_rng(const PassInputs& inputs, const PassKey& key, Stream stream);

}  // namespace mote
