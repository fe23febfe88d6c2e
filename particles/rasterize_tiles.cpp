#include "particles/rasterize_tiles.h"

namespace mote {
namespace {

size_t hash(TileKey key)
{
    const uint32_t h = static_cast<uint32_t>(key.x) * 0x9e3779b1u ^
                       static_cast<uint32_t>(key.y) * 0x85ebca77u ^
                       static_cast<uint32_t>(key.z) * 0xc2b2ae3du;
    return h ^ (h >> 15u);
}

uint8_t to_leaf(float voxel)
{
    return static_cast<uint8_t>(std::clamp(static_cast<int>(voxel), 0, tile_size - 1) / leaf_size);
}

/// Sets the bits of a box of leaves: rows of z bits, copied to each y by one multiplication.
void mark_box(const LeafBox& box, LeafMask& mask)
{
    const uint64_t z_bits = (0xffull >> (7 - box.hi[2])) & (0xffull << box.lo[2]);
    const uint64_t y_rows =
        (0x0101010101010101ull >> (8 * (7 - box.hi[1]))) & (~0ull << (8 * box.lo[1]));
    for (size_t x = box.lo[0]; x <= box.hi[0]; ++x) mask[x] |= z_bits * y_rows;
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

    void add(TileKey key, const Splat& splat, uint32_t particle)
    {
        const uint32_t t = table.find_or_add(key);
        if (t == count.size()) {
            count.push_back(0);
            masks.push_back({});
        }
        const Vec3 p(splat.p_index - Vec3d(key.x, key.y, key.z) * static_cast<double>(tile_size));
        splats.push_back({p.x, p.y, p.z, splat.support, splat.root_density, particle});
        tile.push_back(t);
        ++count[t];
        mark_leaves(splats.back(), masks[t]);
    }
};

/// Adds the splat to every tile that its lattice range meets.
void add_to_tiles(const Splat& splat, uint32_t particle, UnsortedChunk& chunk)
{
    const double h = static_cast<double>(splat.support);
    const auto lo = [&](double c) { return static_cast<int32_t>(std::ceil(c - h)) >> 6; };
    const auto hi = [&](double c) { return static_cast<int32_t>(std::floor(c + h)) >> 6; };
    const TileKey first{lo(splat.p_index.x), lo(splat.p_index.y), lo(splat.p_index.z)};
    const TileKey last{hi(splat.p_index.x), hi(splat.p_index.y), hi(splat.p_index.z)};
    for (int32_t x = first.x; x <= last.x; ++x) {
        for (int32_t y = first.y; y <= last.y; ++y) {
            for (int32_t z = first.z; z <= last.z; ++z) chunk.add({x, y, z}, splat, particle);
        }
    }
}

}  // namespace

LeafBox leaf_box(const TileSplat& s)
{
    return {{to_leaf(std::ceil(s.x - s.support)), to_leaf(std::ceil(s.y - s.support)),
             to_leaf(std::ceil(s.z - s.support))},
            {to_leaf(std::floor(s.x + s.support)), to_leaf(std::floor(s.y + s.support)),
             to_leaf(std::floor(s.z + s.support))}};
}

uint32_t TileTable::find_or_add(TileKey key)
{
    const size_t wrap = slots_.size() - 1;
    size_t slot = hash(key) & wrap;
    while (slots_[slot] != 0) {
        if (keys_[slots_[slot] - 1] == key) return slots_[slot] - 1;
        slot = (slot + 1) & wrap;
    }
    keys_.push_back(key);
    const uint32_t number = static_cast<uint32_t>(keys_.size());
    slots_[slot] = number;
    if (2 * keys_.size() > slots_.size()) grow();
    return number - 1;
}

void TileTable::grow()
{
    slots_.assign(4 * slots_.size(), 0);
    const size_t wrap = slots_.size() - 1;
    for (size_t i = 0; i < keys_.size(); ++i) {
        size_t slot = hash(keys_[i]) & wrap;
        while (slots_[slot] != 0) slot = (slot + 1) & wrap;
        slots_[slot] = static_cast<uint32_t>(i + 1);
    }
}

BinnedChunk bin_chunk(const ParticleSet& particles, const SplatRules& rules, size_t first,
                      size_t last)
{
    UnsortedChunk chunk;
    chunk.splats.reserve((last - first) * 5 / 4);
    chunk.tile.reserve((last - first) * 5 / 4);
    for (size_t i = first; i < last; ++i) {
        if (!is_usable(particles, rules, i)) continue;
        for_each_splat(particles, rules, i, [&](const Splat& splat) {
            add_to_tiles(splat, static_cast<uint32_t>(i), chunk);
        });
    }

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

bool next_leaf_lists(std::span<const std::span<const TileSplat>> segments, size_t max_copies,
                     size_t& segment, size_t& offset, LeafLists& lists)
{
    const size_t first_segment = segment;
    const size_t first_offset = offset;
    std::array<uint32_t, tile_leaves> count{};
    std::vector<LeafBox> boxes;
    size_t copies = 0;
    for (; segment < segments.size(); ++segment, offset = 0) {
        for (; offset < segments[segment].size() && copies < max_copies; ++offset) {
            const TileSplat& splat = segments[segment][offset];
            boxes.push_back(leaf_box(splat));
            for_each_leaf(splat, boxes.back(), [&](int k) {
                ++count[static_cast<size_t>(k)];
                ++copies;
            });
        }
        if (copies >= max_copies) break;
    }
    if (boxes.empty()) return false;

    lists.begin[0] = 0;
    for (size_t k = 0; k < tile_leaves; ++k) lists.begin[k + 1] = lists.begin[k] + count[k];
    lists.splats.resize(copies);
    std::array<uint32_t, tile_leaves> next;
    std::copy_n(lists.begin.begin(), tile_leaves, next.begin());
    size_t from = first_offset;
    size_t s = first_segment;
    for (const LeafBox& box : boxes) {
        while (from == segments[s].size()) {
            ++s;
            from = 0;
        }
        TileSplat splat = segments[s][from++];
        const Vec3 p(splat.x, splat.y, splat.z);
        for_each_leaf(splat, box, [&](int k) {
            TileSplat& copy = lists.splats[next[static_cast<size_t>(k)]++];
            copy = splat;
            copy.x = p.x - static_cast<float>(leaf_size * (k / 64));
            copy.y = p.y - static_cast<float>(leaf_size * (k / 8 % 8));
            copy.z = p.z - static_cast<float>(leaf_size * (k % 8));
        });
    }
    return true;
}

}  // namespace mote
