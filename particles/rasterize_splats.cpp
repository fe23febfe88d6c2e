#include "particles/rasterize_splats.h"

namespace mote {
namespace {

/// Sums of 10^9 products of two such numbers stay finite in float.
constexpr float largest = 1e14f;

bool is_summable(float v)
{
    return std::abs(v) <= largest;  // false for NaN
}

bool is_summable(Vec3 v)
{
    return is_summable(v.x) && is_summable(v.y) && is_summable(v.z);
}

}  // namespace

bool is_usable(const ParticleSet& particles, const SplatRules& rules, size_t i)
{
    const float mass = mass_of(particles, rules, i);
    const double density = static_cast<double>(mass) * rules.inv_voxel_volume;
    if (!(mass > 0.0f) || !(density <= static_cast<double>(largest))) return false;
    if (!is_finite(particles.position[i])) return false;
    if (!particles.radius.empty()) {
        const float radius = particles.radius[i];
        if (!(radius >= 0.0f && radius < infinity)) return false;
    }
    if (rules.use_velocity && !particles.velocity.empty() && !is_summable(particles.velocity[i])) {
        return false;
    }
    if (rules.use_temperature && !is_summable(particles.temperature[i])) return false;
    return !rules.use_color || is_summable(particles.color[i]);
}

void normalise(SplatBatch& batch)
{
    constexpr int n = SplatBatch::capacity;
    float* const centre[3] = {batch.centres.x, batch.centres.y, batch.centres.z};
    for (int axis = 0; axis < 3; ++axis) {
        for (int i = 0; i < n; ++i) {
            const double p =
                std::nearbyint(batch.p_index[axis][i] * positions_per_voxel) / positions_per_voxel;
            const double cell = std::floor(p);
            batch.cell[axis][i] = static_cast<int32_t>(cell);
            centre[axis][i] = static_cast<float>(p - cell);
        }
        for (int i = 0; i < n; ++i) {
            const float h = batch.centres.support[i];
            const int32_t lo = static_cast<int32_t>(std::ceil(centre[axis][i] - h));
            const int32_t hi = static_cast<int32_t>(std::floor(centre[axis][i] + h));
            batch.first_tile[axis][i] = (batch.cell[axis][i] + lo) >> 6;
            batch.last_tile[axis][i] = (batch.cell[axis][i] + hi) >> 6;
        }
    }
    float sum[n];
    kernel_lattice_sums(batch.centres, sum);
    for (int i = 0; i < n; ++i) batch.root_density[i] = std::sqrt(batch.density[i] / sum[i]);
}

}  // namespace mote
