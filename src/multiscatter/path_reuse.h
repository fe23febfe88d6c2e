#pragma once

#include "core/buffer2d.h"
#include "core/parallel.h"
#include "multiscatter/combine_paths.h"
#include "reference/light_sampler.h"
#include "restir/domain_store.h"
#include "restir/reproject.h"
#include "restir/reuse_passes.h"

namespace mote {

/// A pass's paths that later ones may reuse, and what they depend on. Everything per pixel: 76
/// bytes of reservoir, 56 of domain and 12 for each bin edge (about 30 on rays through smoke): 500
/// in smoke, 132 elsewhere.
struct FinishedPaths {
    FrameDomain frame;
    LightSampler lights;
    DomainStore domains;
    Buffer2D<PathReservoir> reservoirs;

    [[nodiscard]] bool empty() const { return domains.empty(); }
    [[nodiscard]] size_t memory_bytes() const
    {
        return domains.memory_bytes() + reservoirs.size() * sizeof(PathReservoir);
    }
};

/// Paths of a pass under way: read by the passes below, never written.
struct PathsView {
    const PathWorld& world;
    const DomainStore& domains;
    const Buffer2D<PathPixel>& pixels;
};

/// Where they write: the pixels of their tile, in both.
struct PathOutput {
    Buffer2D<PathPixel>& pixels;
    Buffer2D<Spectrum>& light;  ///< radiance scattered twice and more
};

/// History as the passes below use it.
struct PathHistory {
    const FinishedPaths& paths;
    const PathWorld& world;  ///< of the pass before
    Change change;           ///< from then to now
};

/// Combines each pixel's paths with those of the pixel it was in the pass before, whose confidence
/// is capped and scaled by profile_agreement. Unbiased whatever has changed: the earlier domain is
/// evaluated as it was, and where media, lights or surfaces are not the same, what paths found with
/// their random numbers is found again on either side, which costs two walks per pixel;
/// IndirectSuffix::BiasedValidated keeps it instead.
void reuse_paths_in_time(const PathsView& pass, const PathHistory& before, const Tile& tile,
                         const PixelRng& rng, const PathOutput& out, ReuseCounts& counts);

/// Combines each pixel's paths with those of neighbours, as reuse_in_space does.
void reuse_paths_in_space(const PathsView& pass, const Tile& tile, const PixelRng& rng,
                          const PathOutput& out, ReuseCounts& counts);

}  // namespace mote
