#pragma once

#include <vector>

#include "restir/coarse_extinction.h"
#include "restir/light_clusters.h"

namespace mote {

/// Chooses clusters that cover all lights once, at most `most`, for the points within `radius` of
/// x: halves again and again the ones whose lights may differ most in what they bring, as long as
/// that matters. Writes indices into clusters.nodes, in the lights' order.
/// After Walter et al. 2005, Lightcuts, with a bound that knows of extinction.
void choose_light_cut(const LightClusters& clusters, const CoarseExtinction& extinction, Vec3 x,
                      float radius, int most, std::vector<int>& cut);

}  // namespace mote
