#include "volumes/bin_batch.h"

#include <vector>

#include "volumes/bin_filler.h"
#include "volumes/ray_block.h"
#include "volumes/ray_order.h"

namespace mote {
namespace {

constexpr int round_steps = 4;  ///< of each ray in one round: early stops waste no more
constexpr size_t most_rays = CellTable::capacity / round_steps;
static_assert(most_rays <= RayBlock::capacity && most_rays % lane_group == 0);

/// Working space of a batch, on the stack: 110 kB.
struct Workspace {
    RayBlock rays;
    PieceList found;
    BrickPiece pieces[CellTable::capacity + 1];
    uint8_t cells[CellTable::capacity];
    uint16_t order[CellTable::capacity];
    uint16_t column[PieceList::capacity];  ///< in `table`, of what was found
    CellTable table;
};

/// Whether a piece lies in a brick of one value.
bool is_uniform(const BrickGrid& grid, const PieceList& found, size_t i)
{
    const BrickRange& range = grid.ranges[static_cast<size_t>(found.brick[i])];
    return range.min == range.max;
}

/// Tabulates the cells of what was found.
void tabulate(const BrickGrid& grid, Workspace& work)
{
    const PieceList& found = work.found;
    uint16_t piece_of[CellTable::capacity];
    size_t count = 0;
    for (size_t i = 0; i < found.count; ++i) {
        if (is_uniform(grid, found, i)) continue;
        const auto ray = static_cast<size_t>(found.ray[i]);
        work.pieces[count] = {{found.p[0][i], found.p[1][i], found.p[2][i]},
                              found.length[i],
                              {work.rays.d[0][ray], work.rays.d[1][ray], work.rays.d[2][ray]},
                              found.brick[i]};
        piece_of[count] = static_cast<uint16_t>(i);
        work.cells[count++] = static_cast<uint8_t>(found.cells[i]);
    }
    sort_by_key<CellTable::most_cells + 1>(std::span(work.cells, count), work.order);
    for (size_t column = 0; column < count; ++column) {
        work.column[piece_of[work.order[column]]] = static_cast<uint16_t>(column);
    }
    work.pieces[count] = {};
    const auto empty = static_cast<uint16_t>(count);
    while (count % lane_group != 0) work.order[count++] = empty;
    walk_kernels().tabulate(grid.values.data(), work.pieces, work.order, count, work.table);
}

/// Hands the cells of a piece to its ray; false when nothing more matters.
bool add_piece(const PieceList& found, size_t i, const CellTable& table, size_t column,
               BinFiller& filler)
{
    const float s = found.s[i];
    float start = 0.0f;
    float before = 0.0f;
    for (size_t r = 0; r < CellTable::most_cells; ++r) {
        const float end = table.end[r][column];
        const float integral = table.integral[r][column];
        // Cells that rounding leaves no length are of no use as edges.
        if (s + end > s + start) {
            if (!filler.add_cell(s + start, s + end, integral - before)) return false;
            start = end;
            before = integral;
        }
        if (!(end < found.length[i])) break;  // the last one
    }
    return true;
}

void bin_rays(const Volume& volume, std::span<const BinQuery> queries, float cut, Workspace& work,
              BinCounts& counts)
{
    const BrickGrid& grid = *volume.density;
    std::vector<BinFiller> fillers;
    fillers.reserve(queries.size());
    for (const BinQuery& query : queries) {
        query.bins->count = 0;
        query.bins->cells = 0;
        const LocalRay ray = density_ray(volume, *query.ray, {0.0f, query.t_end});
        if (ray.misses()) {
            ++counts.misses;
            continue;
        }
        set_ray(work.rays, fillers.size(), grid, ray);
        fillers.emplace_back(volume, ray, cut, *query.bins);
    }
    size_t padded = fillers.size();
    for (; padded % lane_group != 0; ++padded) set_ray(work.rays, padded, grid, LocalRay{});
    const BrickTable table = table_of(grid);
    for (bool any = !fillers.empty(); any;) {
        work.found.count = 0;
        walk_kernels().step(table, work.rays, padded, round_steps, work.found);
        tabulate(grid, work);
        for (size_t i = 0; i < work.found.count; ++i) {
            const auto ray = static_cast<size_t>(work.found.ray[i]);
            BinFiller& filler = fillers[ray];
            if (filler.is_over()) continue;
            const float s = work.found.s[i];
            const bool goes_on =
                is_uniform(grid, work.found, i)
                    ? filler.add_uniform(s, s + work.found.length[i],
                                         grid.ranges[static_cast<size_t>(work.found.brick[i])].max)
                    : add_piece(work.found, i, work.table, work.column[i], filler);
            if (!goes_on) work.rays.s1[ray] = -1.0f;
        }
        any = false;
        for (size_t i = 0; i < padded; ++i) any = any || work.rays.s1[i] > 0.0f;
    }
    for (BinFiller& filler : fillers) filler.finish(counts);
}

}  // namespace

void bin_batch(const Volume& volume, std::span<const BinQuery> queries, float cut,
               BinCounts& counts)
{
    Workspace work;
    for (size_t begin = 0; begin < queries.size(); begin += most_rays) {
        bin_rays(volume, queries.subspan(begin, std::min(most_rays, queries.size() - begin)), cut,
                 work, counts);
    }
}

}  // namespace mote
