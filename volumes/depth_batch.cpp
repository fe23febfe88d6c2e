#include "volumes/depth_batch.h"

#include "core/error.h"
#include "volumes/brick_pieces.h"
#include "volumes/brick_walk.h"
#include "volumes/walk_isa.h"

namespace mote {
namespace {

static_assert(BrickGrid::brick_values == 736 && BrickGrid::brick_stride == 9,
              "brick_pieces_*.cpp know the layout by heart");

constexpr size_t block_rays = 256;  ///< rays taken together
constexpr size_t ray_pieces = 8;    ///< of one ray in one round: early stops waste no more
constexpr size_t block_pieces = block_rays * ray_pieces;
constexpr int most_cells = 22;  ///< of one piece: three axes of seven borders, and the start

/// A ray on its way through one volume.
struct Walker {
    BrickWalk walk;
    Vec3 o, d;
    uint32_t query;
    double limit;  ///< integral at which it may stop [density units x m]
    double integral = 0.0;
    bool is_done = false;
};

/// Working space of one block; on the stack, since threads call for small batches.
struct Block {
    BrickPiece pieces[block_pieces + 1];
    float integral[block_pieces + 1];
    uint16_t walker_of[block_pieces];
    uint16_t order[block_pieces + piece_group];
    uint8_t cells[block_pieces];
    uint16_t bucket[most_cells + 2];
    size_t count;
};

IntegratePieces integrate_pieces()
{
    switch (walk_isa()) {
        case Isa::Avx512:
            return integrate_pieces_avx512;
        case Isa::Avx2:
            return integrate_pieces_avx2;
        case Isa::Scalar:
            break;
    }
    return integrate_pieces_scalar;
}

/// Cells that a piece crosses, up to rounding; it only sorts and counts.
int count_cells(Vec3 from, Vec3 to)
{
    constexpr float last = 8.0f - 0x1p-20f;
    const Vec3i a(glm::clamp(from, Vec3(0.0f), Vec3(last)));
    const Vec3i b(glm::clamp(to, Vec3(0.0f), Vec3(last)));
    return 1 + std::abs(b.x - a.x) + std::abs(b.y - a.y) + std::abs(b.z - a.z);
}

/// Adds the ray's next pieces to the block; bricks of one value are done at once.
void emit_pieces(const BrickGrid& grid, Walker& ray, uint16_t number, Block& block,
                 WalkCounts& counts)
{
    const size_t end = block.count + ray_pieces;
    double expected = ray.integral;  // by the bricks' means: how far it is worth looking ahead
    BrickSpan span;
    while (block.count < end && !(expected > ray.limit)) {
        if (!ray.walk.next(span)) {
            ray.is_done = true;
            return;
        }
        ++counts.bricks;
        const BrickRange& range = grid.ranges[static_cast<size_t>(span.brick)];
        const float length = span.s1 - span.s0;
        expected += static_cast<double>(length * range.mean);
        if (range.min == range.max) {
            ray.integral += static_cast<double>(length * range.max);
            continue;
        }
        const Vec3 p = glm::clamp(ray.o - span.origin + span.s0 * ray.d, Vec3(0.0f), Vec3(8.0f));
        const int cells = count_cells(p, p + length * ray.d);
        counts.cells += static_cast<uint64_t>(cells);
        const size_t i = block.count++;
        block.pieces[i] = {{p.x, p.y, p.z}, length, {ray.d.x, ray.d.y, ray.d.z}, span.brick};
        block.walker_of[i] = number;
        block.cells[i] = static_cast<uint8_t>(cells);
    }
}

/// Orders the pieces by their number of cells (counting sort), whole groups, padded with an empty
/// piece. Returns the padded count.
size_t sort_pieces(Block& block)
{
    std::fill(std::begin(block.bucket), std::end(block.bucket), uint16_t{0});
    for (size_t i = 0; i < block.count; ++i) ++block.bucket[block.cells[i] + 1];
    for (int n = 1; n < most_cells + 2; ++n) {
        block.bucket[n] = static_cast<uint16_t>(block.bucket[n] + block.bucket[n - 1]);
    }
    for (size_t i = 0; i < block.count; ++i) {
        block.order[block.bucket[block.cells[i]]++] = static_cast<uint16_t>(i);
    }
    block.pieces[block.count] = {};
    size_t padded = block.count;
    while (padded % piece_group != 0) block.order[padded++] = static_cast<uint16_t>(block.count);
    return padded;
}

/// Walks the rays to their ends or limits, in rounds of a few bricks each.
void integrate_walkers(const BrickGrid& grid, std::vector<Walker>& rays, Block& block,
                       WalkCounts& counts)
{
    const IntegratePieces integrate = integrate_pieces();
    for (;;) {
        block.count = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            if (!rays[i].is_done) {
                emit_pieces(grid, rays[i], static_cast<uint16_t>(i), block, counts);
            }
        }
        integrate(grid.values.data(), block.pieces, block.order, sort_pieces(block),
                  block.integral);
        for (size_t i = 0; i < block.count; ++i) {
            rays[block.walker_of[i]].integral += static_cast<double>(block.integral[i]);
        }
        bool is_done = true;
        for (Walker& ray : rays) {
            ray.is_done = ray.is_done || ray.integral > ray.limit;
            is_done = is_done && ray.is_done;
        }
        if (is_done) return;
    }
}

void add_volume(const Volume& volume, std::span<const DepthQuery> queries, std::span<float> tau,
                Block& block, std::vector<Walker>& rays, WalkCounts& counts)
{
    const auto scale = static_cast<double>(volume.density_scale);
    rays.clear();
    for (size_t i = 0; i < queries.size(); ++i) {
        const DepthQuery& query = queries[i];
        if (tau[i] > query.tau_max) continue;
        const LocalRay ray = density_ray(volume, {query.o, query.d, query.time}, {0.0f, query.t1});
        if (ray.misses()) continue;
        const double limit = static_cast<double>(query.tau_max - tau[i]) / scale;
        rays.push_back(
            {BrickWalk(*volume.density, ray), ray.o, ray.d, static_cast<uint32_t>(i), limit});
    }
    if (rays.empty()) return;
    counts.rays += rays.size();
    integrate_walkers(*volume.density, rays, block, counts);
    for (const Walker& ray : rays) tau[ray.query] += static_cast<float>(ray.integral * scale);
}

}  // namespace

void optical_depths(const Media& media, std::span<const DepthQuery> queries, std::span<float> tau,
                    WalkCounts& counts)
{
    MOTE_ASSERT(tau.size() == queries.size());
    std::fill(tau.begin(), tau.end(), 0.0f);
    Block block;
    std::vector<Walker> rays;
    rays.reserve(std::min(queries.size(), block_rays));
    for (size_t begin = 0; begin < queries.size(); begin += block_rays) {
        const size_t count = std::min(block_rays, queries.size() - begin);
        for (const Volume& volume : media.volumes) {
            if (is_void(volume)) continue;
            add_volume(volume, queries.subspan(begin, count), tau.subspan(begin, count), block,
                       rays, counts);
        }
    }
}

}  // namespace mote
