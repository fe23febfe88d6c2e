#pragma once

#include <vector>

#include "march/march_lights.h"
#include "scene/march_params.h"

namespace mote {

/// Transmittance towards every light at the nodes of a lattice around all media, linear between
/// them. Exact at the nodes: what is wrong is what happens between. Media stand still in the middle
/// of the shutter. Cost: one exact walk per node and light, in parallel; 4 bytes each.
class ShadowGrid {
  public:
    ShadowGrid(const Media& media, const std::vector<MarchLight>& lights,
               const MarchParams& params);

    /// The eight nodes around a point, and their weights.
    struct Place {
        size_t node[8];
        float weight[8];
    };
    [[nodiscard]] Place place(Vec3 x) const;

    [[nodiscard]] float transmittance(const Place& place, size_t light) const
    {
        float sum = 0.0f;
        for (int i = 0; i < 8; ++i) {
            sum += place.weight[i] * values_[place.node[i] * light_count_ + light];
        }
        return sum;
    }
    [[nodiscard]] size_t memory_bytes() const { return values_.size() * sizeof(float); }
    [[nodiscard]] float spacing() const { return spacing_; }

  private:
    Vec3 lo_{0.0f};
    float spacing_ = 1.0f;  ///< [m]
    Vec3i count_{1};        ///< nodes, at least 2 along each axis
    size_t light_count_ = 0;
    std::vector<float> values_;  ///< per node and light
};

}  // namespace mote
