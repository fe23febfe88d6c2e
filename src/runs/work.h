#pragma once

#include <span>

#include "render/frame.h"

namespace mote {

/// What a frame's image took, counted: no clock, no noise but that of the random numbers. Of whole
/// frames, or per pixel and sample.
struct WorkCounts {
    double camera_rays = 0.0;  ///< tabulated exactly
    double lookups = 0.0;      ///< of density, at tentative collisions
    double cells = 0.0;        ///< walked in closed form one by one
    double bricks = 0.0;       ///< 8^3 voxels at once in closed form
    double shadow_rays = 0.0;  ///< towards lights
    double candidates = 0.0;   ///< weighed for a reservoir
    double reused = 0.0;       ///< reservoirs of earlier passes and of neighbours that took part

    void add(const WorkCounts& other, double factor = 1.0);
};

/// Memory by what it is for [bytes].
struct MemoryUse {
    double grids = 0.0;        ///< bricks of all volumes
    double maps = 0.0;         ///< light caches: transmittance towards distant lights,
    double directions = 0.0;   ///< towards directions all around,
    double environment = 0.0;  ///< the sky's light towards the camera,
    double cells = 0.0;        ///< and the choice among lamps
    double film = 0.0;
    double history = 0.0;  ///< what the next frame may reuse

    [[nodiscard]] double caches() const { return maps + directions + environment + cells; }
};

[[nodiscard]] WorkCounts work_of(const FrameStats& stats);
[[nodiscard]] MemoryUse memory_of(const FrameStats& stats);

/// The counts by name, in the order of reports.
struct WorkField {
    const char* name;
    double WorkCounts::*value;
};
[[nodiscard]] std::span<const WorkField> work_fields();

struct MemoryField {
    const char* name;
    double MemoryUse::*value;
};
[[nodiscard]] std::span<const MemoryField> memory_fields();

}  // namespace mote
