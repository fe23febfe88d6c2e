#pragma once

#include <functional>
#include <span>
#include <vector>

#include "restir/coarse_extinction.h"
#include "restir/light_clusters.h"

namespace mote {

/// A light chosen at a point.
struct LightPick {
    int light = -1;  ///< LocalLight::id; -1: there is none
    float pmf = 0.0f;
};

struct LightCellsParams {
    float edge_voxels = 4.0f;        ///< cell edge [voxels], at least. Larger: cheaper, more noise.
    int most_clusters = 64;          ///< per cell, [1,256]. Cost and memory are linear.
    float floor = 0.02f;             ///< share of choices that ignores what the cache knows, (0,1]
    size_t most_cells = 1u << 17;    ///< cells grow to keep to it. 50 ms of one core at 1 light.
    size_t most_entries = 1u << 22;  ///< cells times clusters; 8 bytes each, about 50 ns
};

/// What many local lights bring to each place in the smoke, per frame: chooses lights for points,
/// and weighs distances along rays. Knows of distance, of the phase function towards the camera and
/// of approximate transmittance. It shapes proposals only: stale or wrong values cost variance,
/// never bias, since every light keeps a probability above 0 everywhere and all are known exactly.
///
/// Each cell divides all lights into at most most_clusters ranges of one spatial order, near lights
/// singly and far ones together (a light cut), and holds their distribution; within a range lights
/// are chosen by power. Outside the smoke lights are chosen by power alone.
class LightCells {
  public:
    LightCells() = default;
    /// Everything, transmittance included. Depends on media and lights alone: while both stay the
    /// same, keep it and call set_eye(). The same for any number of threads.
    LightCells(const Media& media, std::span<const LocalLight> lights, Vec3 eye,
               const LightCellsParams& params = {});

    /// Distributions for another camera position [world]. Cost: about a fifth of building.
    void set_eye(Vec3 eye);

    /// Whether there are no lights to choose from.
    [[nodiscard]] bool is_empty() const { return clusters_.ids.empty(); }

    /// Chooses a light for point x; u in [0,1). Monotone in u in one order of the lights in which
    /// neighbours are near each other: stratified u stratify the lights. With thousands of lights
    /// u needs more bits than a float has. {-1, 0} without lights.
    [[nodiscard]] LightPick sample(Vec3 x, double u) const;

    /// Probability of sample(x) choosing this light; 0 for those it never chooses.
    [[nodiscard]] float pmf(int light, Vec3 x) const;

    /// Approximate luminance scattered towards the camera by all local lights, per unit of
    /// scattering coefficient [W/(m^2 sr)]. Interpolated; above 0 and finite everywhere.
    [[nodiscard]] float inscatter(Vec3 x) const;

    /// Cells that hold a distribution.
    [[nodiscard]] size_t cell_count() const { return cells_.size(); }
    /// Clusters in all cells together.
    [[nodiscard]] size_t entry_count() const { return fluence_.size(); }
    [[nodiscard]] float cell_edge() const { return lattice_.cell; }
    [[nodiscard]] size_t memory_bytes() const;

    /// Replaces what each entry is thought to bring by value(entry) and derives everything from
    /// it. For tests: whatever the values, choices stay exact.
    void overwrite(const std::function<float(size_t)>& value, Vec3 eye);

  private:
    /// A cell with a distribution.
    struct Cell {
        uint32_t position = 0;  ///< in the lattice
        uint32_t cut = 0;       ///< into cuts_
        uint32_t entry = 0;     ///< first of its entries in fluence_ and cdf_
        uint32_t volume = 0;    ///< whose phase function counts here
        float sigma_t = 0.0f;   ///< mean extinction around here [1/m]
    };
    /// The clusters that the cells of one block of 2^3 share.
    struct Cut {
        uint32_t first = 0;  ///< into nodes_ and begins_
        uint32_t count = 0;
    };
    /// What the cache says of one cell, or of everywhere outside.
    struct Row {
        const float* cdf = nullptr;  ///< count values, the last is 1
        const int* nodes = nullptr;
        const int* begins = nullptr;  ///< first light of each range and the end of the last
        uint32_t count = 0;
        float sigma_t = 0.0f;
    };
    [[nodiscard]] Row row_at(Vec3 x) const;
    /// Probability of going left at a node that is not a leaf.
    [[nodiscard]] double left_share(const LightCluster& node, int index, Vec3 x,
                                    float sigma_t) const;
    void make_cells(const Media& media, const SmokeCells& smoke, const LightCellsParams& params,
                    const CoarseExtinction& extinction);
    void make_cuts(const CoarseExtinction& extinction, const std::vector<Vec3i>& blocks,
                   int most_clusters);
    void fill_fluence(const CoarseExtinction& extinction);
    void fill_cell(const Cell& cell, Vec3 eye);
    void fill_inscatter();

    LightClusters clusters_;
    std::vector<Phase> phases_;
    float floor_share_ = 0.02f;
    Lattice lattice_;
    std::vector<int32_t> cell_at_;  ///< per lattice position; -1: none
    std::vector<float> inscatter_;  ///< per lattice position, at the cell's centre
    float least_inscatter_ = 1.0f;
    std::vector<Cell> cells_;
    std::vector<Cut> cuts_;
    std::vector<int> nodes_;        ///< of all cuts, into clusters_.nodes
    std::vector<int> begins_;       ///< of all cuts, one more each than nodes
    std::vector<float> fluence_;    ///< per entry: shadowed, before scattering [W/m^2]
    std::vector<float> cdf_;        ///< per entry
    std::vector<float> scattered_;  ///< per cell: sum of what is scattered to the eye
    int everything_[2] = {0, 0};    ///< the one range used outside
};

}  // namespace mote
