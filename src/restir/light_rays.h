#pragma once

#include <span>
#include <vector>

#include "scene/scene.h"
#include "volumes/depth_batch.h"

namespace mote {

/// Rays towards lights, gathered over a tile and traced together. Each brings weight * T to its
/// owner (a pixel of the tile, or a term of one), T the exact transmittance of its segment: 0 if a
/// surface is in between.
struct LightRays {
    std::vector<DepthQuery> queries;
    std::vector<Spectrum> weights;
    std::vector<int> owners;
    std::vector<float> depths;  ///< filled by trace

    void clear();
    /// A ray from x along wi. Rays whose weight is black are left out.
    void add(int owner, Vec3 x, Vec3 wi, float distance, float time, Spectrum weight,
             float tau_max);
    void trace(const Scene& scene, WalkCounts& counts);
    /// The same through other media; surfaces may be null.
    void trace(const Surfaces* surfaces, const Media& media, WalkCounts& counts);
    /// The same through coarse media, whose depths are marched (march_depths), not exact; surfaces
    /// may be null.
    void guess(const Surfaces* surfaces, const Media& coarse, WalkCounts& counts);
    [[nodiscard]] size_t size() const { return queries.size(); }
    /// What ray i brings.
    [[nodiscard]] Spectrum value(size_t i) const { return weights[i] * std::exp(-depths[i]); }

  private:
    using Walk = decltype(optical_depths);
    void walk_open(const Surfaces* surfaces, const Media& media, Walk& walk, WalkCounts& counts);
};

/// Optical depth beyond which a contribution is below 1e-7 of the pixel: what it would bring
/// without anything in the way, against what the pixel is thought to have. That may come from wrong
/// caches, so it is never below 18 (1e-8 of the contribution itself); where the pixel is not
/// thought to have anything, as deep as floats go.
[[nodiscard]] float depth_that_matters(Spectrum weight, float pixel_luminance);

}  // namespace mote
