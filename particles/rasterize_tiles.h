#pragma once

#include <array>
#include <bit>
#include <cstring>
#include <vector>

#include "particles/rasterize_chains.h"
#include "particles/rasterize_plan.h"

namespace mote {

inline constexpr int leaf_size = 8;  ///< voxels per edge of an OpenVDB leaf
inline constexpr int tile_leaves = 512;

/// Which tile: voxels [64 x, 64 x + 63] and so on.
struct TileKey {
    int32_t x, y, z;

    bool operator==(const TileKey&) const = default;
};

/// The leaves of one tile that a splat may touch: a box of them, both ends included.
struct LeafBox {
    int32_t lo[4];  ///< x, y, z, unused
    int32_t hi[4];
};

/// Clipped to the tile. Precondition: the splat touches the tile.
[[nodiscard]] inline LeafBox leaf_box(const TileSplat& s)
{
    using Float4 = float __attribute__((vector_size(16)));
    using Int4 = int32_t __attribute__((vector_size(16)));
    // Truncation is rounding down for positive numbers; a support never reaches further than this.
    constexpr float shift = 2.0f * max_support_voxels;
    constexpr int32_t shift_back = static_cast<int32_t>(shift);
    const auto leaf = [](Float4 voxel) {
        const Int4 v = __builtin_convertvector(voxel, Int4) - shift_back;
        const Int4 from_0 = v > 0 ? v : v - v;
        return (from_0 < tile_size - 1 ? from_0 : from_0 - from_0 + (tile_size - 1)) / leaf_size;
    };
    const Float4 p = {s.x, s.y, s.z, 0.0f};
    LeafBox box;
    // The first voxel inside is the one after the rounded-down border.
    const Int4 lo = leaf(p - s.support + (shift + 1.0f));
    const Int4 hi = leaf(p + s.support + shift);
    std::memcpy(box.lo, &lo, sizeof lo);
    std::memcpy(box.hi, &hi, sizeof hi);
    return box;
}

/// Supports [voxels] up to which all leaves of the box count as touched; wider ones leave out the
/// corners of the box outside their sphere.
inline constexpr float box_is_enough = 4.0f;

/// Calls f(leaf number) for the leaves that the splat touches, in ascending order.
template <class F>
void for_each_leaf(const TileSplat& splat, const LeafBox& box, F&& f)
{
    if (splat.support <= box_is_enough) {  // at most two leaves along each axis
        // Corners of a box of 1 or 2 leaves per axis as bits x y z, and how many there are. One
        // loop instead of three nested ones: half the mispredicted branches.
        static constexpr uint8_t corners[8][8] = {
            {0},    {0, 1},       {0, 2},       {0, 1, 2, 3},
            {0, 4}, {0, 1, 4, 5}, {0, 2, 4, 6}, {0, 1, 2, 3, 4, 5, 6, 7}};
        static constexpr int steps[8] = {0, 1, 8, 9, 64, 65, 72, 73};
        const int shape =
            4 * (box.hi[0] - box.lo[0]) + 2 * (box.hi[1] - box.lo[1]) + (box.hi[2] - box.lo[2]);
        const int first = 64 * box.lo[0] + 8 * box.lo[1] + box.lo[2];
        const int count = 1 << std::popcount(static_cast<unsigned>(shape));
        for (int i = 0; i < count; ++i) f(first + steps[corners[shape][i]]);
        return;
    }
    // Squared distance from c to the lattice points of leaf k along one axis.
    const auto gap2 = [](int k, float c) {
        const float first = static_cast<float>(k * leaf_size);
        return sqr(std::max(0.0f, std::max(first - c, c - (first + leaf_size - 1))));
    };
    for (int x = box.lo[0]; x <= box.hi[0]; ++x) {
        for (int y = box.lo[1]; y <= box.hi[1]; ++y) {
            const float xy2 = gap2(x, splat.x) + gap2(y, splat.y);
            for (int z = box.lo[2]; z <= box.hi[2]; ++z) {
                if (xy2 + gap2(z, splat.z) < sqr(splat.support)) f(64 * x + 8 * y + z);
            }
        }
    }
}

/// Numbers tiles in the order in which they are first asked for (open addressing, no deletion).
class TileTable {
  public:
    TileTable() : slots_(256, 0) {}
    [[nodiscard]] uint32_t find_or_add(TileKey key)
    {
        const size_t wrap = slots_.size() - 1;
        for (size_t slot = hash(key) & wrap; slots_[slot] != 0; slot = (slot + 1) & wrap) {
            if (keys_[slots_[slot] - 1] == key) return slots_[slot] - 1;
        }
        return add(key);
    }
    [[nodiscard]] const std::vector<TileKey>& keys() const { return keys_; }

  private:
    [[nodiscard]] static size_t hash(TileKey key)
    {
        const uint32_t h = static_cast<uint32_t>(key.x) * 0x9e3779b1u ^
                           static_cast<uint32_t>(key.y) * 0x85ebca77u ^
                           static_cast<uint32_t>(key.z) * 0xc2b2ae3du;
        return h ^ (h >> 15u);
    }
    uint32_t add(TileKey key);
    void insert(size_t number);

    std::vector<TileKey> keys_;
    std::vector<uint32_t> slots_;  ///< tile number + 1; 0 = free
};

/// The splats of a run of particles by tile, in particle order within each. A splat appears once
/// for every tile that it touches.
struct BinnedChunk {
    TileTable tiles;
    SplatChains splats;  ///< one bucket per tile
};

/// Bins the particles of a chunk.
[[nodiscard]] BinnedChunk bin_chunk(const ParticleSet& particles, const SplatRules& rules,
                                    const ChunkRange& chunk);

}  // namespace mote
