#pragma once

#include "multiscatter/scatter_nodes.h"
#include "volumes/ray_bins.h"

namespace mote {

/// Light scattered twice and more towards the camera, along one binned ray, as far as the nodes
/// know it: trilinear between nodes at the bins' edges, linear in optical depth between edges,
/// which integrates in closed form. Biased by the nodes' spacing (measured: -0.6 % at 0.4 mean free
/// paths of the densest smoke, -1.8 % at 0.8). Cost: a look-up per edge.
[[nodiscard]] Spectrum scatter_along(const ScatterNodes& nodes, const Media& media, const Ray& ray,
                                     const RayBins& bins);

}  // namespace mote
