#pragma once

#include <cstdint>

#include "particles/kernel.h"
#include "particles/particle_set.h"

namespace mote {

/// Widest support that is rasterised; wider means that the voxels are needlessly small.
inline constexpr float max_support_voxels = 256.0f;
/// Most stamps along one motion-blurred path. Longer paths get this many, farther apart than half
/// a support, and may show as beads: a particle that crosses 128 radii in one shutter.
inline constexpr int max_stamps = 256;
/// Positions are rounded to 2^-17 voxel, so that every float copy of one, relative to any tile or
/// leaf near it, is exact and the lattice sum that normalises it holds for all of them.
inline constexpr double positions_per_voxel = 131072.0;

/// How particles become splats in index space.
struct SplatRules {
    double index_from_world;  ///< [voxels/m]
    double inv_voxel_volume;  ///< [1/m^3]
    double open_s;            ///< shutter, seconds relative to the particles' time
    double close_s;
    float missing_mass;  ///< [kg] where the set has no masses
    bool use_velocity;   ///< blur or velocity channel
    bool use_temperature;
    bool use_color;

    [[nodiscard]] bool blurs() const { return close_s != open_s; }
};

/// One kernel footprint: density (root_density (1 - r^2/support^2))^2 [kg/m^3].
struct Splat {
    Vec3d p_index;
    float support;       ///< [voxels], min_support_voxels or more
    float root_density;  ///< square root of the density at the centre
};

/// False for particles that cannot or need not contribute: massless, or with a value that is not
/// finite or so large that sums of it could overflow.
[[nodiscard]] bool is_usable(const ParticleSet& particles, const SplatRules& rules, size_t i);

/// Support radius [voxels] of particle i.
[[nodiscard]] inline float support_of(const ParticleSet& particles, const SplatRules& rules,
                                      size_t i)
{
    if (particles.radius.empty()) return min_support_voxels;
    const double h = static_cast<double>(particles.radius[i]) * rules.index_from_world;
    return std::max(min_support_voxels, static_cast<float>(h));
}

/// Stamps along the path of particle i, at most half a support apart; 1 without blur.
[[nodiscard]] inline int stamp_count(const ParticleSet& particles, const SplatRules& rules,
                                     size_t i, float support)
{
    if (!rules.blurs() || particles.velocity.empty()) return 1;
    const double speed = glm::length(Vec3d(particles.velocity[i])) * rules.index_from_world;
    const double steps =
        std::abs(rules.close_s - rules.open_s) * speed / (0.5 * static_cast<double>(support));
    return steps < max_stamps ? std::max(1, static_cast<int>(std::ceil(steps))) : max_stamps;
}

/// Mass of particle i [kg].
[[nodiscard]] inline float mass_of(const ParticleSet& particles, const SplatRules& rules, size_t i)
{
    return particles.mass.empty() ? rules.missing_mass : particles.mass[i];
}

/// Calls f(splat) for each stamp of particle i, which must be usable and in range. Stamps sit at
/// the middles of equal parts of the shutter, so their centroid is the path's.
template <class F>
void for_each_splat(const ParticleSet& particles, const SplatRules& rules, size_t i, F&& f)
{
    const float support = support_of(particles, rules, i);
    const int count = stamp_count(particles, rules, i, support);
    const double density =
        static_cast<double>(mass_of(particles, rules, i)) * rules.inv_voxel_volume / count;
    for (int k = 0; k < count; ++k) {
        Vec3d p(particles.position[i]);
        if (rules.blurs() && !particles.velocity.empty()) {
            const double u = (k + 0.5) / count;
            p += Vec3d(particles.velocity[i]) * (rules.open_s + u * (rules.close_s - rules.open_s));
        }
        p *= rules.index_from_world * positions_per_voxel;
        p = Vec3d(std::nearbyint(p.x), std::nearbyint(p.y), std::nearbyint(p.z)) /
            positions_per_voxel;
        const Vec3d in_cell(p.x - std::floor(p.x), p.y - std::floor(p.y), p.z - std::floor(p.z));
        const double sum = kernel_lattice_sum(Vec3(in_cell), support);
        f(Splat{p, support, static_cast<float>(std::sqrt(density / sum))});
    }
}

}  // namespace mote
