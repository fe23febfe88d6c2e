#include "particles/rasterize_tiles.h"

namespace mote {
namespace {

/// Sets the bits of a box of leaves: rows of z bits, copied to each y by one multiplication.
void mark_box(const LeafBox& box, LeafMask& mask)
{
    const uint64_t z_bits = (0xffull >> (7 - box.hi[2])) & (0xffull << box.lo[2]);
    const uint64_t y_rows =
        (0x0101010101010101ull >> (8 * (7 - box.hi[1]))) & (~0ull << (8 * box.lo[1]));
    for (int x = box.lo[0]; x <= box.hi[0]; ++x) mask[static_cast<size_t>(x)] |= z_bits * y_rows;
}

void mark_leaves(const TileSplat& splat, LeafMask& mask)
{
    const LeafBox box = leaf_box(splat);
    if (splat.support <= box_is_enough) {
        mark_box(box, mask);
        return;
    }
    for_each_leaf(splat, box,
                  [&](int k) { mask[static_cast<size_t>(k) / 64] |= 1ull << (k % 64); });
}

/// Splats of a chunk in particle order, each with its tile's number in the chunk.
struct UnsortedChunk {
    TileTable table;
    std::vector<TileSplat> splats;
    std::vector<uint32_t> tile;
    std::vector<uint32_t> count;  ///< splats per tile
    std::vector<LeafMask> masks;

    void add(TileKey key, const SplatBatch& batch, int i)
    {
        const uint32_t t = table.find_or_add(key);
        if (t == count.size()) {
            count.push_back(0);
            masks.push_back({});
        }
        const auto local = [&](int axis, int32_t tile_key, float centre) {
            return static_cast<float>(batch.cell[axis][i] - tile_size * tile_key) + centre;
        };
        splats.push_back({local(0, key.x, batch.centres.x[i]), local(1, key.y, batch.centres.y[i]),
                          local(2, key.z, batch.centres.z[i]), batch.centres.support[i],
                          batch.root_density[i], batch.particle[i]});
        tile.push_back(t);
        ++count[t];
        mark_leaves(splats.back(), masks[t]);
    }

    /// Adds splat i of the batch to every tile that it meets.
    void add_to_tiles(const SplatBatch& batch, int i)
    {
        for (int32_t x = batch.first_tile[0][i]; x <= batch.last_tile[0][i]; ++x) {
            for (int32_t y = batch.first_tile[1][i]; y <= batch.last_tile[1][i]; ++y) {
                for (int32_t z = batch.first_tile[2][i]; z <= batch.last_tile[2][i]; ++z) {
                    add({x, y, z}, batch, i);
                }
            }
        }
    }
};

}  // namespace

uint32_t TileTable::add(TileKey key)
{
    keys_.push_back(key);
    if (2 * keys_.size() > slots_.size()) {
        slots_.assign(4 * slots_.size(), 0);
        for (size_t i = 0; i < keys_.size(); ++i) insert(i);
    } else {
        insert(keys_.size() - 1);
    }
    return static_cast<uint32_t>(keys_.size() - 1);
}

void TileTable::insert(size_t number)
{
    const size_t wrap = slots_.size() - 1;
    size_t slot = hash(keys_[number]) & wrap;
    while (slots_[slot] != 0) slot = (slot + 1) & wrap;
    slots_[slot] = static_cast<uint32_t>(number + 1);
}

BinnedChunk bin_chunk(const ParticleSet& particles, const SplatRules& rules, size_t first,
                      size_t last, bool all_usable)
{
    UnsortedChunk chunk;
    chunk.splats.reserve((last - first) * 5 / 4);
    chunk.tile.reserve((last - first) * 5 / 4);
    for_each_batch(particles, rules, first, last, all_usable, [&](const SplatBatch& batch) {
        for (int i = 0; i < batch.count; ++i) chunk.add_to_tiles(batch, i);
    });

    BinnedChunk out;
    out.keys = chunk.table.keys();
    out.masks = std::move(chunk.masks);
    out.begin.assign(out.keys.size() + 1, 0);
    for (size_t t = 0; t < out.keys.size(); ++t) out.begin[t + 1] = out.begin[t] + chunk.count[t];
    out.splats = std::make_unique_for_overwrite<TileSplat[]>(chunk.splats.size());
    std::vector<uint32_t> next(out.begin.begin(), out.begin.end() - 1);
    for (size_t i = 0; i < chunk.splats.size(); ++i) {
        out.splats[next[chunk.tile[i]]++] = chunk.splats[i];
    }
    return out;
}

}  // namespace mote
