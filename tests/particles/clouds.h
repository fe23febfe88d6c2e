#pragma once

#include <cmath>

#include <openvdb/openvdb.h>

#include "core/rng.h"
#include "particles/particle_set.h"
#include "particles/rasterize_params.h"

namespace mote {

inline ParticleSet one_particle(Vec3 position, float radius, float mass = 1.0f)
{
    ParticleSet set;
    set.position = {position};
    set.radius = {radius};
    set.mass = {mass};
    return set;
}

/// `count` particles in a cube of `edge` metres around the origin, radii in [r0, r1].
inline ParticleSet random_cloud(size_t count, float edge, float r0, float r1, uint32_t seed)
{
    ParticleSet set;
    for (uint32_t i = 0; i < count; ++i) {
        Rng rng(seed, 0, Stream::Test, i, 0);
        set.position.push_back((rng.uniform3() - Vec3(0.5f)) * edge);
        set.velocity.push_back((rng.uniform3() - Vec3(0.5f)) * 4.0f);
        set.radius.push_back(r0 + (r1 - r0) * rng.uniform());
        set.mass.push_back(0.5f + rng.uniform());
        set.temperature.push_back(300.0f + 100.0f * rng.uniform());
        set.color.push_back(rng.uniform3());
    }
    return set;
}

inline RasterizeParams voxels_of(float size)
{
    RasterizeParams params;
    params.voxel_size = size;
    return params;
}

/// Sum of density times voxel volume [kg].
inline double mass_in(const openvdb::FloatGrid& grid)
{
    double sum = 0.0;
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
        for (auto v = leaf->cbeginValueOn(); v; ++v) sum += static_cast<double>(*v);
    }
    return sum * std::pow(grid.voxelSize()[0], 3.0);
}

inline double total_mass(const ParticleSet& set)
{
    double sum = 0.0;
    for (const float m : set.mass) sum += static_cast<double>(m);
    return sum;
}

}  // namespace mote
