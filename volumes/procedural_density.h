#pragma once

#include "volumes/grid_source.h"

namespace mote {

/// Density of a procedural volume, voxel by voxel. Voxel (0,0,0) is centred half a voxel inside
/// the low corner of the box params.size around the object's origin.
class ProceduralDensity {
  public:
    ProceduralDensity(const ProceduralParams& params, double time_s);

    /// Density in [0,1] of a voxel. A box's voxels hold the share that the box covers, so that the
    /// optical depth across it is exact for any size.
    [[nodiscard]] float at(Vec3i voxel) const;

  private:
    struct Range {
        float lo = 0.0f;
        float hi = 0.0f;
    };
    /// Where t matters to offset + scale * t if that is cut off below lo and above hi.
    static Range range_between(float lo, float hi, float offset, float scale);

    [[nodiscard]] float box(Vec3i voxel) const;
    [[nodiscard]] float sphere(Vec3 p) const;
    [[nodiscard]] float puff(Vec3 p) const;
    [[nodiscard]] float plume(Vec3 p) const;
    /// Octaves of noise; those that cannot bring the sum back into where it matters are left out.
    [[nodiscard]] float turbulence(Vec3 p, float rise, Range matters) const;

    ProceduralParams params_;
    float phase_ = 0.0f;
    int octaves_ = 1;
};

}  // namespace mote
