#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "particles/rasterize_splats.h"

namespace mote {

inline constexpr int leaf_size = 8;   ///< voxels per edge of an OpenVDB leaf
inline constexpr int tile_size = 64;  ///< voxels per edge of a tile: 8^3 leaves
inline constexpr int tile_leaves = 512;

/// Which tile: voxels [64 x, 64 x + 63] and so on.
struct TileKey {
    int32_t x, y, z;

    bool operator==(const TileKey&) const = default;
};

/// One splat as a tile or leaf sees it: position relative to the tile's or leaf's first voxel.
struct TileSplat {
    float x, y, z;
    float support;
    float root_density;
    uint32_t particle;  ///< where the other attributes are
};

/// One bit per leaf of a tile: word x, bit 8 y + z.
using LeafMask = std::array<uint64_t, 8>;

/// The leaves of one tile that a splat may touch: a box of them, both ends included.
struct LeafBox {
    uint8_t lo[3];
    uint8_t hi[3];
};

/// Clipped to the tile. Precondition: the splat touches the tile.
[[nodiscard]] LeafBox leaf_box(const TileSplat& splat);

/// Supports [voxels] up to which all leaves of the box count as touched; wider ones leave out the
/// corners of the box outside their sphere.
inline constexpr float box_is_enough = 6.0f;

/// Calls f(leaf number) for the leaves that the splat touches, in ascending order.
template <class F>
void for_each_leaf(const TileSplat& splat, const LeafBox& box, F&& f)
{
    // Squared distance from c to the lattice points of leaf k along one axis.
    const auto gap2 = [](int k, float c) {
        const float first = static_cast<float>(k * leaf_size);
        return sqr(std::max(0.0f, std::max(first - c, c - (first + leaf_size - 1))));
    };
    const float reach2 = splat.support > box_is_enough ? sqr(splat.support) : infinity;
    for (int x = box.lo[0]; x <= box.hi[0]; ++x) {
        const float x2 = gap2(x, splat.x);
        for (int y = box.lo[1]; y <= box.hi[1]; ++y) {
            const float xy2 = x2 + gap2(y, splat.y);
            for (int z = box.lo[2]; z <= box.hi[2]; ++z) {
                if (xy2 + gap2(z, splat.z) < reach2) f(64 * x + 8 * y + z);
            }
        }
    }
}

/// Numbers tiles in the order in which they are first asked for (open addressing, no deletion).
class TileTable {
  public:
    TileTable() : slots_(256, 0) {}
    [[nodiscard]] uint32_t find_or_add(TileKey key);
    [[nodiscard]] const std::vector<TileKey>& keys() const { return keys_; }

  private:
    void grow();

    std::vector<TileKey> keys_;
    std::vector<uint32_t> slots_;  ///< tile number + 1; 0 = free
};

/// The splats of a run of particles, grouped by tile and in particle order within each: splats of
/// tile t are [begin[t], begin[t + 1]). A splat appears once for every tile that it touches.
struct BinnedChunk {
    std::vector<TileKey> keys;
    std::vector<LeafMask> masks;  ///< leaves touched, per tile
    std::vector<uint32_t> begin;
    std::unique_ptr<TileSplat[]> splats;

    [[nodiscard]] std::span<const TileSplat> of_tile(size_t t) const
    {
        return {splats.get() + begin[t], begin[t + 1] - begin[t]};
    }
};

/// Bins particles [first, last).
[[nodiscard]] BinnedChunk bin_chunk(const ParticleSet& particles, const SplatRules& rules,
                                    size_t first, size_t last);

/// Splats of one tile by leaf, in particle order, positions relative to the leaf: those of leaf k
/// are [begin[k], begin[k + 1]).
struct LeafLists {
    std::array<uint32_t, tile_leaves + 1> begin;
    std::vector<TileSplat> splats;

    [[nodiscard]] std::span<const TileSplat> of_leaf(int k) const
    {
        const uint32_t first = begin[static_cast<size_t>(k)];
        return {splats.data() + first, begin[static_cast<size_t>(k) + 1] - first};
    }
};

/// Sorts the splats of a tile into its leaves, beginning at `segments[segment][offset]` and
/// stopping once about `max_copies` copies are made; advances `segment` and `offset`, and returns
/// false when none were left. Bounds the memory of wide splats, which touch many leaves.
bool next_leaf_lists(std::span<const std::span<const TileSplat>> segments, size_t max_copies,
                     size_t& segment, size_t& offset, LeafLists& lists);

}  // namespace mote
