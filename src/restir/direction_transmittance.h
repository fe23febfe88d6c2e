#pragma once

#include "restir/cache_stats.h"
#include "restir/direction_hats.h"
#include "restir/smoke_lattice.h"
#include "surfaces/surfaces.h"

namespace mote {

/// The defaults suit images of a million pixels; for small ones 32 directions (4 x 8) or maps twice
/// as coarse halve the cost for up to twice the error. Figures: bench_light_caches.
struct DirectionTransmittanceParams {
    DirectionHats hats;         ///< error falls and cost grows with the number of directions
    float node_spacing = 0.0f;  ///< of the lattice [m]; 0: four of the finest voxels
    float map_spacing = 0.0f;   ///< of the rays of each direction [m]; 0: node_spacing
    int node_budget = 100'000;  ///< active nodes; the spacing grows to fit
};

/// Transmittance from every place in the smoke towards a set of directions all around: one
/// TransmittanceMap per pair of opposite directions, through media coarsened to half the distance
/// between its rays, resampled to the nodes of one lattice. Approximate: see there.
/// Surfaces (null: none) are asked by one ray per node and direction.
/// Knows nothing of lights, so it stays valid while media and surfaces do. Memory: 4 bytes per
/// active node and direction.
class DirectionTransmittance {
  public:
    explicit DirectionTransmittance(const Media& media,
                                    const DirectionTransmittanceParams& params = {},
                                    const Surfaces* surfaces = nullptr);

    /// From world point x towards wi [unit], in [0,1], linear between nodes and directions. 1 far
    /// from smoke. Floor it before using it in a target.
    [[nodiscard]] float transmittance(Vec3 x, Vec3 wi) const;

    /// The media that were walked, which share the grids of those given where these are coarse
    /// enough, and the largest voxel that they may have [m].
    [[nodiscard]] const Media& walked_media() const { return walked_media_; }
    [[nodiscard]] float walked_voxel() const { return walked_voxel_; }

    [[nodiscard]] const DirectionHats& hats() const { return hats_; }
    [[nodiscard]] const SmokeLattice& lattice() const { return lattice_; }
    /// Transmittances of one slot of the lattice, row_size() of them: first hats().count() values,
    /// then zeros. All 1 for slot 0.
    [[nodiscard]] const float* row(int32_t slot) const
    {
        return rows_.data() + static_cast<size_t>(slot) * row_size_;
    }
    /// A multiple of 8.
    [[nodiscard]] size_t row_size() const { return row_size_; }
    [[nodiscard]] const CacheStats& stats() const { return stats_; }

  private:
    DirectionHats hats_;
    SmokeLattice lattice_;
    size_t row_size_ = 0;
    std::vector<float> rows_;
    Media walked_media_;
    float walked_voxel_ = 0.0f;
    CacheStats stats_;
};

}  // namespace mote
