#pragma once

#include <span>

#include "core/rng.h"
#include "multiscatter/shift_path.h"
#include "restir/reuse_mis.h"

namespace mote {

/// A pixel's own reservoir from all its paths: streaming RIS. Each walk is worth `share` of the
/// pixel's light. `color` becomes the light of all.
[[nodiscard]] PathPixel resample_paths(const PathEndpoint& own, std::span<const DrawnPath> paths,
                                       float share, Rng& rng, Spectrum& color);

/// Another reservoir that a pixel combines with its own.
struct OtherPath {
    ShiftedPath here;          ///< its path in the pixel's domain; f is black if there is none
    float p_hat_there = 0.0f;  ///< target of that path where it comes from
    float W = 0.0f;
    float M = 0.0f;          ///< confidence
    float age = 0.0f;        ///< [passes]
    float own_there = 0.0f;  ///< target of the pixel's own path in the other's domain, Jacobian
                             ///< included
};

/// Shifts both ways. `confidence` counts whether or not the other has a path that gets here.
/// `map` leads from the other to the pixel.
[[nodiscard]] OtherPath make_other_path(const PathReservoir& mine, const PathEndpoint& own,
                                        const PathReservoir& other, const PathEndpoint& from,
                                        float confidence, const PathMap& map);

/// One reservoir of all inputs, with resampling MIS weights by `form` (Balance: for one other at
/// most). `color` becomes the estimate of the pixel's light: all inputs by their MIS weights, which
/// has the mean of the chosen path's and less noise.
[[nodiscard]] PathPixel combine_paths(const PathPixel& own, std::span<const OtherPath> others,
                                      MisForm form, Rng& rng, Spectrum& color);

}  // namespace mote
