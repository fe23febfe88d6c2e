#include "volumes/depth_batch.h"

#include "core/error.h"
#include "volumes/ray_block.h"
#include "volumes/ray_order.h"

namespace mote {
namespace {

constexpr int round_steps = 4;  ///< of each ray in one round: early stops waste no more
static_assert(RayBlock::capacity * round_steps <= PieceList::capacity);

/// Working space of a batch, 90 kB on the stack: allocating it would cost small batches more.
struct Workspace {
    RayBlock rays;
    size_t ray_count;
    uint32_t query[RayBlock::capacity];   ///< whose ray it is
    double limit[RayBlock::capacity];     ///< integral at which it stops [density units x m]
    double integral[RayBlock::capacity];  ///< so far

    PieceList found;
    BrickPiece pieces[PieceList::capacity + 1];
    uint16_t ray_of[PieceList::capacity];
    uint8_t cells[PieceList::capacity];
    uint16_t order[PieceList::capacity + lane_group];
    float piece_integral[PieceList::capacity + 1];
    size_t piece_count;
};

/// The rays that meet the volume and have something left to lose, padded to whole groups.
void start_rays(const Volume& volume, std::span<const DepthQuery> queries,
                std::span<const float> tau, std::span<const uint32_t> chosen, Workspace& work)
{
    size_t count = 0;
    for (const uint32_t i : chosen) {
        const DepthQuery& query = queries[i];
        if (tau[i] > query.tau_max) continue;
        const LocalRay ray = density_ray(volume, {query.o, query.d, query.time}, {0.0f, query.t1});
        if (ray.misses()) continue;
        set_ray(work.rays, count, *volume.density, ray);
        work.query[count] = i;
        work.limit[count] =
            static_cast<double>(query.tau_max - tau[i]) / static_cast<double>(volume.density_scale);
        work.integral[count++] = 0.0;
    }
    work.ray_count = count;
    LocalRay ended;
    for (; count % lane_group != 0; ++count) set_ray(work.rays, count, *volume.density, ended);
}

/// Turns what the walk found into pieces to integrate; bricks of one value are done at once.
void take_pieces(const BrickGrid& grid, Workspace& work, WalkCounts& counts)
{
    const PieceList& found = work.found;
    size_t count = 0;
    for (size_t i = 0; i < found.count; ++i) {
        const auto ray = static_cast<size_t>(found.ray[i]);
        const BrickRange& range = grid.ranges[static_cast<size_t>(found.brick[i])];
        const float length = found.length[i];
        if (range.min == range.max) {
            work.integral[ray] += static_cast<double>(length * range.max);
            continue;
        }
        work.pieces[count] = {{found.p[0][i], found.p[1][i], found.p[2][i]},
                              length,
                              {work.rays.d[0][ray], work.rays.d[1][ray], work.rays.d[2][ray]},
                              found.brick[i]};
        work.ray_of[count] = static_cast<uint16_t>(ray);
        work.cells[count++] = static_cast<uint8_t>(found.cells[i]);
        counts.cells += static_cast<uint64_t>(found.cells[i]);
    }
    counts.bricks += found.count;
    counts.uniform_bricks += found.count - count;
    work.piece_count = count;
}

/// Orders the pieces by their number of cells, padded to whole groups with an empty piece. Returns
/// the padded count.
size_t sort_pieces(Workspace& work)
{
    size_t count = work.piece_count;
    sort_by_key<CellTable::most_cells + 1>(std::span(work.cells, count), work.order);
    work.pieces[count] = {};
    const auto empty = static_cast<uint16_t>(count);
    while (count % lane_group != 0) work.order[count++] = empty;
    return count;
}

/// Ends the rays that are over their limits; false if all have ended.
bool stop_rays(Workspace& work)
{
    bool any = false;
    for (size_t i = 0; i < work.ray_count; ++i) {
        if (work.integral[i] > work.limit[i]) work.rays.s1[i] = -1.0f;
        any = any || work.rays.s1[i] > 0.0f;
    }
    return any;
}

void add_volume(const Volume& volume, std::span<const DepthQuery> queries, std::span<float> tau,
                std::span<const uint32_t> chosen, Workspace& work, WalkCounts& counts)
{
    const BrickGrid& grid = *volume.density;
    const BrickTable table = table_of(grid);
    const WalkKernels& walk = walk_kernels();
    start_rays(volume, queries, tau, chosen, work);
    counts.rays += work.ray_count;
    const size_t padded = (work.ray_count + lane_group - 1) / lane_group * lane_group;
    for (bool any = work.ray_count > 0; any; any = stop_rays(work)) {
        work.found.count = 0;
        walk.step(table, work.rays, padded, round_steps, work.found);
        take_pieces(grid, work, counts);
        walk.integrate(grid.values.data(), work.pieces, work.order, sort_pieces(work),
                       work.piece_integral);
        for (size_t i = 0; i < work.piece_count; ++i) {
            work.integral[work.ray_of[i]] += static_cast<double>(work.piece_integral[i]);
        }
    }
    for (size_t i = 0; i < work.ray_count; ++i) {
        const double depth = work.integral[i] * static_cast<double>(volume.density_scale);
        tau[work.query[i]] += static_cast<float>(depth);
    }
}

}  // namespace

void optical_depths(const Media& media, std::span<const DepthQuery> queries, std::span<float> tau,
                    WalkCounts& counts)
{
    MOTE_ASSERT(tau.size() == queries.size());
    std::fill(tau.begin(), tau.end(), 0.0f);
    const auto order = order_by_direction(queries);
    Workspace work;
    for (size_t begin = 0; begin < order.size(); begin += RayBlock::capacity) {
        const size_t count = std::min(RayBlock::capacity, order.size() - begin);
        for (const Volume& volume : media.volumes) {
            if (is_void(volume)) continue;
            add_volume(volume, queries, tau, std::span(order).subspan(begin, count), work, counts);
        }
    }
}

}  // namespace mote
