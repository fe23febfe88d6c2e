#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "volumes/depth_batch.h"
#include "volumes/ray_block.h"
#include "volumes/ray_order.h"

namespace mote {
namespace {

/// Length of a step, at most. Measured on the plumes of bench_frame, through the coarse media of
/// the sky's rays: as good as exact depths.
constexpr float voxels_per_step = 2.0f;

/// Working space, on the stack.
struct Workspace {
    MarchBlock rays;
    LocalRay local[MarchBlock::capacity];
    uint32_t query[MarchBlock::capacity];
    uint8_t steps[MarchBlock::capacity];  ///< clamped; about equal ones run side by side
    uint16_t order[MarchBlock::capacity];
    float integral[MarchBlock::capacity];
    float lookups[MarchBlock::capacity];
};

float steps_of(const LocalRay& ray)
{
    return std::max(1.0f, std::ceil(ray.s1 * glm::length(ray.d) / voxels_per_step));
}

void set_ray(MarchBlock& rays, size_t i, const LocalRay& ray, float limit)
{
    for (int axis = 0; axis < 3; ++axis) {
        const bool moves = std::abs(ray.d[axis]) > 1e-30f;
        rays.o[axis][i] = ray.o[axis];
        rays.d[axis][i] = ray.d[axis];
        rays.inv[axis][i] = moves ? 1.0f / ray.d[axis] : 0.0f;
    }
    rays.s1[i] = ray.s1;
    rays.step[i] = ray.s1 / steps_of(ray);
    rays.limit[i] = limit;
}

/// Nothing to march.
void set_ended(MarchBlock& rays, size_t i)
{
    for (int axis = 0; axis < 3; ++axis) {
        rays.o[axis][i] = rays.d[axis][i] = rays.inv[axis][i] = 0.0f;
    }
    rays.s1[i] = -1.0f;
    rays.step[i] = 1.0f;
    rays.limit[i] = 0.0f;
}

void add_volume(const Volume& volume, std::span<const DepthQuery> queries, std::span<float> tau,
                std::span<const uint32_t> chosen, Workspace& work, WalkCounts& counts)
{
    size_t count = 0;
    for (const uint32_t i : chosen) {
        const DepthQuery& query = queries[i];
        if (tau[i] > query.tau_max) continue;
        const LocalRay ray = density_ray(volume, {query.o, query.d, query.time}, {0.0f, query.t1});
        if (ray.misses()) continue;
        work.local[count] = ray;
        work.steps[count] = static_cast<uint8_t>(std::min(255.0f, steps_of(ray)));
        work.query[count++] = i;
    }
    sort_by_key<256>(std::span(work.steps, count), work.order);
    for (size_t n = 0; n < count; ++n) {
        const uint32_t i = work.query[work.order[n]];
        set_ray(work.rays, n, work.local[work.order[n]],
                (queries[i].tau_max - tau[i]) / volume.density_scale);
    }
    size_t padded = count;
    while (padded % lane_group != 0) set_ended(work.rays, padded++);
    const BrickGrid& grid = *volume.density;
    walk_kernels().march(table_of(grid), grid.values.data(), work.rays, padded, work.integral,
                         work.lookups);
    for (size_t n = 0; n < count; ++n) {
        tau[work.query[work.order[n]]] += volume.density_scale * work.integral[n];
        counts.cells += static_cast<uint64_t>(work.lookups[n]);
    }
    counts.rays += count;
}

}  // namespace

void march_depths(const Media& media, std::span<const DepthQuery> queries, std::span<float> tau,
                  WalkCounts& counts)
{
    MOTE_ASSERT(tau.size() == queries.size());
    std::fill(tau.begin(), tau.end(), 0.0f);
    const auto order = order_by_direction(queries);
    Workspace work;
    for (size_t begin = 0; begin < order.size(); begin += MarchBlock::capacity) {
        const size_t count = std::min(MarchBlock::capacity, order.size() - begin);
        const auto chosen = std::span(order).subspan(begin, count);
        for (const Volume& volume : media.volumes) {
            if (!is_void(volume)) add_volume(volume, queries, tau, chosen, work, counts);
        }
    }
}

}  // namespace mote
