#pragma once

#include "restir/coarse_extinction.h"
#include "restir/light_clusters.h"
#include "volumes/phase.h"

namespace mote {

/// Eight clusters side by side; those never set have no power.
struct ClusterLanes {
    Float8 x{}, y{}, z{};  ///< centre [m]
    Float8 power{};        ///< [W]
    Float8 spread2{};      ///< [m^2]
    Float8 facing_x{}, facing_y{}, facing_z{};

    void set(int lane, const LightCluster& cluster);
};

/// What clusters bring to a place.
struct FluenceLanes {
    Float8 tau{};       ///< approximate optical depth to the centre
    Float8 expected{};  ///< fluence [W/m^2], shadows included, scattering apart
    Float8 weight{};    ///< the same, but never far too small: what lights are chosen by
};

/// Relative variance of coarse optical depths that lights are chosen with. Measured on the plume of
/// bench_light_cells: 0.2 to 0.5 are alike; without it, choices at optical depth 40 have five to
/// ten times the variance.
inline constexpr float coarse_doubt = 0.3f;

/// Fluence around x. Below the squared distance `blur2` [m^2] the inverse square law is levelled
/// off. `steps` as in coarse_optical_depths.
///
/// Optical depth is only known with an error, and differs among a cluster's lights. Taken as
/// gamma-distributed around its estimate with relative variance v, the mean transmittance is
/// (1 + v tau)^(-1/v). exp(-tau) would be far too small for what is seen through thinner parts, and
/// choices of too small a probability are what noise is made of.
void eval_fluence(const ClusterLanes& clusters, const CoarseExtinction& extinction, Vec3 x,
                  float blur2, int steps, FluenceLanes& out);

/// Phase function [1/sr] for light of each cluster scattered at x to `wo`, averaged roughly over
/// the directions in which the cluster is seen from points around x.
void eval_phase(const ClusterLanes& clusters, Vec3 x, Vec3 wo, const Phase& phase, float blur2,
                Float8& out);

}  // namespace mote
