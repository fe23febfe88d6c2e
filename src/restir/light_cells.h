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
    float edge_voxels = 4.0f;  ///< cell edge [voxels], at least. Larger: cheaper, more noise.
    /// Clusters per cell, [1,256]; 64 (or this, if less) where entries are short.
    int most_clusters = 128;
    float floor = 0.02f;  ///< share of choices that ignores what the cache knows, [0.001,1]
    size_t most_cells = 1u << 17;    ///< cells grow to keep to it: 50 ms of one core for one light
    size_t most_entries = 1u << 22;  ///< cells times clusters: 6 bytes and about 50 ns each
};

/// What many local lights bring to each place in the smoke, per frame: chooses lights for points,
/// and weighs distances along rays. Knows of distance, of the phase function towards the camera and
/// of approximate transmittance. It shapes proposals only: stale or wrong values cost variance,
/// never bias, since every light keeps a probability above 0 everywhere and all are known exactly.
///
/// Each cell divides all lights into at most most_clusters ranges of one spatial order, near lights
/// singly and far ones together (a light cut), and holds their distribution; within a range, a walk
/// down the tree of lights chooses by power and distance from x. Outside the smoke that walk starts
/// at the root. Cost of a choice: 0.06 us among 100 lights, 0.1 among 1000, 0.5 among a million.
class LightCells {
  public:
    LightCells() = default;
    /// Everything, transmittance included. Depends on media and lights alone: while both stay the
    /// same, keep it and call set_eye(). The same for any number of threads.
    LightCells(const Media& media, std::span<const LocalLight> lights, Vec3 eye,
               const LightCellsParams& params = {});

    /// Distributions for another camera position [world]. Cost: about a seventh of building.
    void set_eye(Vec3 eye);

    /// Whether there are no lights to choose from.
    [[nodiscard]] bool is_empty() const { return clusters_.ids.empty(); }

    /// Chooses a light for point x; u in [0,1). Monotone in u in one order of the lights in which
    /// neighbours are near each other: stratified u stratify the lights. With thousands of lights
    /// u needs more bits than a float has. {-1, 0} without lights.
    [[nodiscard]] LightPick sample(Vec3 x, double u) const;

    /// The same for several u, out.size() of them: faster than one by one, since what they wait for
    /// from memory comes together.
    void sample(Vec3 x, std::span<const double> u, std::span<LightPick> out) const;

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
        uint32_t position = 0;   ///< in the lattice
        uint32_t cut = 0;        ///< into cuts_
        uint32_t entry = 0;      ///< first of its entries in fluence_ and cdf_
        uint32_t volume = 0;     ///< whose phase function counts here
        float certainty = 1.0f;  ///< expected fluence over the larger one that chooses lights
    };
    /// The clusters that the cells of one block of 2^3 share.
    struct Cut {
        uint32_t first = 0;  ///< into nodes_ and begins_
        uint32_t count = 0;
    };
    /// What the cache says of one cell, or of everywhere outside.
    struct Row {
        const uint16_t* cdf = nullptr;
        const int* nodes = nullptr;
        const int* begins = nullptr;  ///< first light of each range and the end of the last
        uint32_t count = 0;
    };
    [[nodiscard]] Row row_at(Vec3 x) const;
    /// A choice on its way down the tree.
    struct Descent {
        int index = 0;      ///< of a node
        double rest = 0.0;  ///< what is left of u, in [0,1)
        double pmf = 1.0;   ///< of coming here
    };
    [[nodiscard]] static Descent enter(const Row& row, double u);
    void step(const LightCluster& node, Vec3 x, Descent& d) const;
    [[nodiscard]] LightPick pick_within(const LightCluster& leaf, const Descent& d) const;
    /// Probability of going left at a node that is not a leaf.
    [[nodiscard]] double left_share(const LightCluster& node, int index, Vec3 x) const;
    void make_cells(const Media& media, const SmokeCells& smoke, const CoarseExtinction& extinction,
                    int most_clusters);
    void make_cuts(const CoarseExtinction& extinction, const std::vector<Vec3i>& blocks,
                   int most_clusters);
    void fill_fluence(const CoarseExtinction& extinction);
    class CutLanes;
    void fill_cell(const Cell& cell, const CutLanes& lanes, Vec3 eye);
    void fill_inscatter();

    LightClusters clusters_;
    std::vector<Phase> phases_;
    float floor_share_ = 0.02f;
    Lattice lattice_;
    std::vector<int32_t> cell_at_;  ///< per lattice position; -1: none
    std::vector<float> inscatter_;  ///< per lattice position, at the cell's centre
    float least_inscatter_ = 1e-20f;
    std::vector<Cell> cells_;
    std::vector<Cut> cuts_;
    std::vector<int> nodes_;      ///< of all cuts, into clusters_.nodes
    std::vector<int> begins_;     ///< of all cuts, one more each than nodes
    std::vector<float> fluence_;  ///< per entry: shadowed, before scattering [W/m^2]
    /// Per entry: 65536 times the probability of the cell's entries up to this one, rounded so that
    /// each has at least 1. The last of a cell stands for 65536.
    std::vector<uint16_t> cdf_;
    std::vector<float> scattered_;  ///< per cell: sum of what is scattered to the eye
    int everything_[2] = {0, 0};    ///< the one range used outside
};

}  // namespace mote
