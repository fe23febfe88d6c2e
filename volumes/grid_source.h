#pragma once

#include <memory>
#include <string>

#include "core/math.h"

namespace mote {

/// Analytic shapes for tests and first scenes, sampled into a grid. Object space, metres.
enum class ProceduralKind { Box, Sphere, Puff, Plume };

/// Box and Sphere are of constant density 1 (a sphere's edge is one voxel wide); Puff falls off
/// smoothly and carries fractal noise; Plume is a rising turbulent column with empty gaps.
struct ProceduralParams {
    ProceduralKind kind = ProceduralKind::Puff;
    Vec3 size{1.0f};           ///< edge lengths or diameters [m]
    float voxel_size = 0.02f;  ///< [m]
    float noise = 0.5f;        ///< strength of the turbulence, [0,1]
    uint32_t seed = 1;
    float evolve = 0.0f;  ///< noise phase per second: animates the turbulence
};

/// Limits and counts of reading an untrusted grid file.
struct GridBudget {
    int64_t max_file_bytes = 64'000'000'000;
    int64_t max_voxels = 4'000'000'000;  ///< active voxels, tiles counted in full
    int64_t max_brick_bytes = 16'000'000'000;
};

struct GridLoadReport {
    int64_t non_finite = 0;  ///< replaced by 0
    int64_t negative = 0;    ///< clamped to 0
};

}  // namespace mote
