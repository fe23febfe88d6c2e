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
    if (!particles.radius.empty() && !(particles.radius[i] >= 0.0f)) return false;
    if (rules.use_velocity && !particles.velocity.empty() && !is_summable(particles.velocity[i])) {
        return false;
    }
    if (rules.use_temperature && !is_summable(particles.temperature[i])) return false;
    return !rules.use_color || is_summable(particles.color[i]);
}

}  // namespace mote
