#include "particles/rasterize.h"

#include <atomic>

#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include "core/error.h"
#include "core/parallel.h"
#include "core/text.h"
#include "particles/rasterize_leaf.h"

namespace mote {
namespace {

using FloatLeaf = openvdb::FloatTree::LeafNodeType;
using Vec3Leaf = openvdb::Vec3STree::LeafNodeType;

/// The leaves of all grids at one place. Until finished, channels hold sums weighted by density.
struct LeafSet {
    std::unique_ptr<FloatLeaf> density;
    std::unique_ptr<Vec3Leaf> velocity;
    std::unique_ptr<FloatLeaf> temperature;
    std::unique_ptr<Vec3Leaf> color;
};

/// Splats of one tile in one chunk.
struct TilePart {
    const SplatChains* chunk;
    size_t bucket;
};

/// One tile of the result. `leaves` are those touched so far, `numbers` their numbers, ascending.
struct GridTile {
    TileKey key;
    std::vector<size_t> numbers;
    std::vector<TilePart> parts;  ///< of this wave, in particle order
    std::vector<LeafSet> leaves;
};

/// Which attributes are rasterised, and their components in the order velocity, temperature,
/// colour.
struct ChannelList {
    bool velocity;
    bool temperature;
    bool color;
    std::vector<AttributeComponent> components;
};

ChannelList make_channels(const ParticleSet& particles, const RasterChannels& wanted)
{
    ChannelList list{wanted.velocity && !particles.velocity.empty(),
                     wanted.temperature && !particles.temperature.empty(),
                     wanted.color && !particles.color.empty(),
                     {}};
    const auto add = [&](const float* data, size_t stride) {
        for (size_t c = 0; c < stride; ++c) list.components.push_back({data + c, stride});
    };
    if (list.velocity) add(&particles.velocity[0].x, 3);
    if (list.temperature) add(particles.temperature.data(), 1);
    if (list.color) add(&particles.color[0].x, 3);
    return list;
}

openvdb::Coord leaf_origin(TileKey key, size_t number)
{
    const int k = static_cast<int>(number);
    return {key.x * tile_size + leaf_size * (k / 64), key.y * tile_size + leaf_size * (k / 8 % 8),
            key.z * tile_size + leaf_size * (k % 8)};
}

LeafSet make_leaves(const openvdb::Coord& origin, const ChannelList& channels)
{
    LeafSet set;
    const openvdb::Vec3f zero(0.0f);
    set.density = std::make_unique<FloatLeaf>(origin, 0.0f);
    if (channels.velocity) set.velocity = std::make_unique<Vec3Leaf>(origin, zero);
    if (channels.temperature) set.temperature = std::make_unique<FloatLeaf>(origin, 0.0f);
    if (channels.color) set.color = std::make_unique<Vec3Leaf>(origin, zero);
    return set;
}

/// Counts the voxels of all leaves before they are allocated.
class VoxelBudget {
  public:
    explicit VoxelBudget(const RasterizeParams& params) : params_(params) {}

    void spend(size_t leaves)
    {
        const int64_t voxels = static_cast<int64_t>(leaf_voxels * leaves);
        if (spent_.fetch_add(voxels) + voxels <= params_.max_voxels) return;
        throw Error(
            ExitCode::Memory,
            fmt::format("the particles touch more than {} voxels of {:g} m, the limit ({} for the "
                        "density alone); raise voxel_size, lower the particles' radius, or raise "
                        "max_voxels",
                        params_.max_voxels, params_.voxel_size,
                        format_bytes(4.0 * static_cast<double>(params_.max_voxels))));
    }

  private:
    const RasterizeParams& params_;
    std::atomic<int64_t> spent_{0};
};

/// Allocates the leaves that these lists touch first.
void allocate_leaves(GridTile& tile, const SplatChains& lists, const ChannelList& channels,
                     VoxelBudget& budget)
{
    std::vector<size_t> numbers;
    size_t old = 0;
    for (size_t k = 0; k < tile_leaves; ++k) {
        const bool exists = old < tile.numbers.size() && tile.numbers[old] == k;
        if (exists) ++old;
        if (exists || lists.count(k) > 0) numbers.push_back(k);
    }
    if (numbers.size() == tile.numbers.size()) return;
    budget.spend(numbers.size() - tile.numbers.size());
    std::vector<LeafSet> leaves;
    leaves.reserve(numbers.size());
    old = 0;
    for (const size_t k : numbers) {
        const bool exists = old < tile.numbers.size() && tile.numbers[old] == k;
        leaves.push_back(exists ? std::move(tile.leaves[old++])
                                : make_leaves(leaf_origin(tile.key, k), channels));
    }
    tile.numbers = std::move(numbers);
    tile.leaves = std::move(leaves);
}

void add_field(const std::array<float, leaf_voxels>& sums, FloatLeaf& leaf)
{
    float* values = leaf.buffer().data();
    for (size_t v = 0; v < leaf_voxels; ++v) values[v] += sums[v];
}

void add_fields(const std::array<float, leaf_voxels>* sums, Vec3Leaf& leaf)
{
    openvdb::Vec3f* values = leaf.buffer().data();
    for (size_t v = 0; v < leaf_voxels; ++v) {
        values[v] += openvdb::Vec3f(sums[0][v], sums[1][v], sums[2][v]);
    }
}

template <int Channels>
void add_splats(const SplatChains& lists, size_t leaf, const ChannelList& channels, LeafSet& leaves)
{
    LeafSums<Channels> sums;
    accumulate_leaf<Channels>(lists, leaf, channels.components.data(), sums);
    const auto* field = sums.field.data();
    add_field(*field++, *leaves.density);
    if constexpr (Channels > 0) {
        if (leaves.velocity) {
            add_fields(field, *leaves.velocity);
            field += 3;
        }
        if (leaves.temperature) add_field(*field++, *leaves.temperature);
        if (leaves.color) add_fields(field, *leaves.color);
    }
}

void add_splats(const SplatChains& lists, size_t leaf, const ChannelList& channels, LeafSet& leaves)
{
    switch (channels.components.size()) {
        case 0:
            return add_splats<0>(lists, leaf, channels, leaves);
        case 1:
            return add_splats<1>(lists, leaf, channels, leaves);
        case 3:
            return add_splats<3>(lists, leaf, channels, leaves);
        case 4:
            return add_splats<4>(lists, leaf, channels, leaves);
        case 6:
            return add_splats<6>(lists, leaf, channels, leaves);
        default:
            return add_splats<7>(lists, leaf, channels, leaves);
    }
}

/// Adds this wave's splats of one tile to its leaves.
void rasterize_tile(GridTile& tile, const ChannelList& channels, ChainsPool& pool,
                    VoxelBudget& budget)
{
    std::vector<std::span<const TileSplat>> segments;
    for (const TilePart& part : tile.parts) {
        part.chunk->for_each_block(part.bucket, [&](auto block) { segments.push_back(block); });
    }
    tile.parts.clear();
    std::unique_ptr<SplatChains> lists = pool.take();
    size_t segment = 0;
    size_t offset = 0;
    while (fill_leaf_lists(segments, segment, offset, *lists)) {
        allocate_leaves(tile, *lists, channels, budget);
        parallel_for(tile.leaves.size(), 16, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) {
                if (lists->count(tile.numbers[i]) == 0) continue;
                add_splats(*lists, tile.numbers[i], channels, tile.leaves[i]);
            }
        });
    }
    pool.give_back(std::move(lists));
}

template <class Leaf>
void finish_mean(const FloatLeaf& density, Leaf& leaf)
{
    leaf.setValueMask(density.getValueMask());
    const float* weight = density.buffer().data();
    auto* values = leaf.buffer().data();
    for (size_t v = 0; v < leaf_voxels; ++v) {
        if (weight[v] > 0.0f) values[v] /= weight[v];
    }
}

/// Sets the active voxels and turns weighted sums into means. Leaves without mass are dropped.
void finish(LeafSet& set)
{
    const float* density = set.density->buffer().data();
    FloatLeaf::NodeMaskType mask;
    for (openvdb::Index w = 0; w < leaf_voxels / 64; ++w) {
        uint64_t bits = 0;
        for (uint32_t i = 0; i < 64; ++i) {
            bits |= static_cast<uint64_t>(density[64 * w + i] > 0.0f) << i;
        }
        mask.getWord<openvdb::Index64>(w) = bits;
    }
    if (mask.isOff()) {
        set = {};
        return;
    }
    set.density->setValueMask(mask);
    if (set.velocity) finish_mean(*set.density, *set.velocity);
    if (set.temperature) finish_mean(*set.density, *set.temperature);
    if (set.color) finish_mean(*set.density, *set.color);
}

template <class Grid>
typename Grid::Ptr make_grid(const char* name, float voxel_size)
{
    auto grid = Grid::create();
    grid->setName(name);
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setTransform(
        openvdb::math::Transform::createLinearTransform(static_cast<double>(voxel_size)));
    return grid;
}

/// Hands the leaves of one field over to a grid.
template <class Grid, class Leaf>
typename Grid::Ptr build_grid(const char* name, const RasterizeParams& params,
                              std::vector<GridTile>& tiles, std::unique_ptr<Leaf> LeafSet::*field)
{
    auto grid = make_grid<Grid>(name, params.voxel_size);
    auto accessor = grid->getAccessor();
    for (GridTile& tile : tiles) {
        for (LeafSet& set : tile.leaves) {
            if (set.*field) accessor.addLeaf((set.*field).release());
        }
    }
    return grid;
}

/// The tiles seen so far, numbered by a table.
struct TileMap {
    TileTable table;
    std::vector<GridTile> tiles;

    void add(const BinnedChunk& chunk)
    {
        for (size_t t = 0; t < chunk.tiles.keys().size(); ++t) {
            const uint32_t number = table.find_or_add(chunk.tiles.keys()[t]);
            if (number == tiles.size()) tiles.push_back({chunk.tiles.keys()[t], {}, {}, {}});
            tiles[number].parts.push_back({&chunk.splats, t});
        }
    }
};

std::vector<GridTile> fill_tiles(const ParticleSet& particles, const RasterPlan& plan,
                                 const RasterizeParams& params, const ChannelList& channels)
{
    TileMap map;
    ChainsPool pool;
    VoxelBudget budget(params);
    size_t first = 0;
    for (const size_t end : plan.wave_end) {
        std::vector<BinnedChunk> binned(end - first);
        parallel_for(binned.size(), 1, [&](size_t begin, size_t stop) {
            for (size_t c = begin; c < stop; ++c) {
                binned[c] = bin_chunk(particles, plan.rules, plan.chunks[first + c]);
            }
        });
        for (const BinnedChunk& chunk : binned) map.add(chunk);
        parallel_for(map.tiles.size(), 1, [&](size_t begin, size_t stop) {
            for (size_t t = begin; t < stop; ++t) {
                rasterize_tile(map.tiles[t], channels, pool, budget);
            }
        });
        first = end;
    }
    return std::move(map.tiles);
}

ParticleGrids rasterize_checked(const ParticleSet& particles, const RasterizeParams& params)
{
    openvdb::initialize();
    const RasterPlan plan = make_raster_plan(particles, params);
    if (plan.invalid > 0) {
        spdlog::warn(
            "{} of {} particles left out: negative masses or radii, or values that are not finite "
            "or "
            "beyond 1e14 (masses: per volume of a voxel, in kg/m^3)",
            plan.invalid, particles.size());
    }
    const ChannelList channels = make_channels(particles, params.channels);
    std::vector<GridTile> tiles = fill_tiles(particles, plan, params, channels);
    parallel_for(tiles.size(), 1, [&](size_t begin, size_t end) {
        for (size_t t = begin; t < end; ++t) {
            for (LeafSet& set : tiles[t].leaves) finish(set);
        }
    });

    ParticleGrids grids;
    grids.density = build_grid<openvdb::FloatGrid>("density", params, tiles, &LeafSet::density);
    if (channels.velocity) {
        grids.velocity =
            build_grid<openvdb::Vec3SGrid>("velocity", params, tiles, &LeafSet::velocity);
    }
    if (channels.temperature) {
        grids.temperature =
            build_grid<openvdb::FloatGrid>("temperature", params, tiles, &LeafSet::temperature);
    }
    if (channels.color) {
        grids.color = build_grid<openvdb::Vec3SGrid>("Cd", params, tiles, &LeafSet::color);
    }
    return grids;
}

}  // namespace

ParticleGrids rasterize(const ParticleSet& particles, const RasterizeParams& params)
{
    try {
        return rasterize_checked(particles, params);
    } catch (const std::bad_alloc&) {
        throw Error(ExitCode::Memory, fmt::format("out of memory while rasterising {} particles; "
                                                  "raise voxel_size or lower their count",
                                                  particles.size()));
    } catch (const openvdb::Exception& e) {
        throw Error(ExitCode::Input, fmt::format("cannot make grids with voxel_size {:g} m: {}",
                                                 params.voxel_size, printable(e.what())));
    }
}

}  // namespace mote
