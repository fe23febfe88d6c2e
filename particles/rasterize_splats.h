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
inline constexpr int tile_size = 64;  ///< voxels per edge of a tile: 8^3 leaves

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

/// Up to eight kernel footprints, components apart: densities (root_density (1 - r^2/h^2))^2
/// [kg/m^3] around cell + centre [voxels]. Filled in two steps: `add`, then `normalise`.
struct SplatBatch {
    static constexpr int capacity = 8;

    int count = 0;
    double p_index[3][capacity]{};
    float density[capacity]{};  ///< mass over voxel volume [kg/m^3]
    uint32_t particle[capacity]{};
    KernelCentres centres{{}, {}, {}, {1, 1, 1, 1, 1, 1, 1, 1}};

    // Set by normalise.
    int32_t cell[3][capacity];
    int32_t first_tile[3][capacity];  ///< tiles that the support meets, both ends included
    int32_t last_tile[3][capacity];
    float root_density[capacity];

    void add(Vec3d p, float support, float splat_density, size_t index)
    {
        p_index[0][count] = p.x;
        p_index[1][count] = p.y;
        p_index[2][count] = p.z;
        density[count] = splat_density;
        particle[count] = static_cast<uint32_t>(index);
        centres.support[count++] = support;
    }
};

/// Rounds positions, splits them into cell and centre, and divides densities by lattice sums.
void normalise(SplatBatch& batch);

/// False for particles that cannot or need not contribute: of mass 0, or with a negative mass or
/// radius, or a value that is not finite or so large that sums of it could overflow.
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

/// Calls f(batch) for the splats of particles [first, last) in order; all must be in range, and
/// those that are not usable are left out. Stamps sit at the middles of equal parts of the
/// shutter, so their centroid is the path's.
template <class F>
void for_each_batch(const ParticleSet& particles, const SplatRules& rules, size_t first,
                    size_t last, bool all_usable, F&& f)
{
    SplatBatch batch;
    const auto flush = [&] {
        normalise(batch);
        f(batch);
        batch.count = 0;
    };
    const bool blurs = rules.blurs() && !particles.velocity.empty();
    for (size_t i = first; i < last; ++i) {
        if (!all_usable && !is_usable(particles, rules, i)) continue;
        const float support = support_of(particles, rules, i);
        const int stamps = stamp_count(particles, rules, i, support);
        const float density = static_cast<float>(static_cast<double>(mass_of(particles, rules, i)) *
                                                 rules.inv_voxel_volume / stamps);
        for (int k = 0; k < stamps; ++k) {
            Vec3d p(particles.position[i]);
            if (blurs) {
                const double t = rules.open_s + (k + 0.5) / stamps * (rules.close_s - rules.open_s);
                p += Vec3d(particles.velocity[i]) * t;
            }
            batch.add(p * rules.index_from_world, support, density, i);
            if (batch.count == SplatBatch::capacity) flush();
        }
    }
    if (batch.count > 0) flush();
}

}  // namespace mote
