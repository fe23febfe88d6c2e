#include "particles/rasterize_tiles.h"

namespace mote {
namespace {

void add_to_tile(BinnedChunk& chunk, TileKey key, const SplatBatch& batch, int i)
{
    const uint32_t tile = chunk.tiles.find_or_add(key);
    if (tile == chunk.splats.bucket_count()) chunk.splats.add_bucket();
    const auto local = [&](int axis, int32_t tile_key, float centre) {
        return static_cast<float>(batch.cell[axis][i] - tile_size * tile_key) + centre;
    };
    chunk.splats.append(tile) = {local(0, key.x, batch.centres.x[i]),
                                 local(1, key.y, batch.centres.y[i]),
                                 local(2, key.z, batch.centres.z[i]),
                                 batch.centres.support[i],
                                 batch.root_density[i],
                                 batch.particle[i]};
}

/// Adds splat i of the batch to every tile that it meets.
void add_to_tiles(BinnedChunk& chunk, const SplatBatch& batch, int i)
{
    for (int32_t x = batch.first_tile[0][i]; x <= batch.last_tile[0][i]; ++x) {
        for (int32_t y = batch.first_tile[1][i]; y <= batch.last_tile[1][i]; ++y) {
            for (int32_t z = batch.first_tile[2][i]; z <= batch.last_tile[2][i]; ++z) {
                add_to_tile(chunk, {x, y, z}, batch, i);
            }
        }
    }
}

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

BinnedChunk bin_chunk(const ParticleSet& particles, const SplatRules& rules,
                      const ChunkRange& chunk)
{
    BinnedChunk binned;
    for_each_batch(particles, rules, chunk.first, chunk.last, chunk.all_usable,
                   [&](const SplatBatch& batch) {
                       for (int i = 0; i < batch.count; ++i) add_to_tiles(binned, batch, i);
                   });
    return binned;
}

}  // namespace mote
