#pragma once

#include <optional>

#include "volumes/emission.h"

namespace mote {

/// A point on a ray, picked for the light that reaches the ray's origin from there.
struct LineSample {
    float t = 0.0f;    ///< world distance [m]
    float pdf = 0.0f;  ///< [1/m]
};

/// Picks a distance on the ray about in proportion to the emission that arrives: bricks by their
/// mean emission and the mean extinction before them. Empty if the ray meets no emissive brick.
/// `bricks` must be the volume's own. Cost: a walk over the bricks on the ray.
[[nodiscard]] std::optional<LineSample> sample_emissive_line(const Volume& volume,
                                                             const EmissiveBricks& bricks,
                                                             const Ray& ray, float u);

/// Density [1/m] with which sample_emissive_line picks distance t.
[[nodiscard]] float emissive_line_pdf(const Volume& volume, const EmissiveBricks& bricks,
                                      const Ray& ray, float t);

}  // namespace mote
