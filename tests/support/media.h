#pragma once

#include <functional>
#include <vector>

#include "volumes/tracking.h"

namespace mote::test {

/// A cube of voxels_per_edge^3 samples of density(p), p in object space, centred at the origin,
/// with this edge between the outermost samples; outside, the reconstruction falls to 0 within one
/// voxel. Identity transform.
inline Volume cube_volume(int voxels_per_edge, float edge,
                          const std::function<float(Vec3)>& density)
{
    const int n = voxels_per_edge;
    const float voxel = edge / static_cast<float>(n - 1);
    std::vector<float> values;
    for (int x = 0; x < n; ++x) {
        for (int y = 0; y < n; ++y) {
            for (int z = 0; z < n; ++z) {
                values.push_back(density(Vec3(x, y, z) * voxel - 0.5f * edge));
            }
        }
    }
    const Affine index_from_object{Mat3(1.0f / voxel), Vec3(0.5f * edge / voxel)};
    Volume volume;
    volume.name = "cube";
    volume.density = make_dense_bricks(Vec3i(n), values, index_from_object);
    volume.albedo = Spectrum(1.0f);
    return volume;
}

/// Cube of constant density 1.
inline Volume constant_cube(int voxels_per_edge = 10, float edge = 2.0f)
{
    return cube_volume(voxels_per_edge, edge, [](Vec3) { return 1.0f; });
}

/// Sphere of radius 1 and constant density 1, its edge smoothed over one voxel.
inline Volume unit_sphere(int voxels_per_edge = 40)
{
    const float edge = 2.2f;
    const float voxel = edge / static_cast<float>(voxels_per_edge - 1);
    return cube_volume(voxels_per_edge, edge, [voxel](Vec3 p) {
        return std::clamp((1.0f - glm::length(p)) / voxel + 0.5f, 0.0f, 1.0f);
    });
}

/// Clumps and holes, densities in [0, 1], empty near the faces of a cube of edge 2.
inline Volume clumpy_cube(int voxels_per_edge = 24)
{
    return cube_volume(voxels_per_edge, 2.0f, [](Vec3 p) {
        const float wave =
            std::sin(7.0f * p.x + 1.0f) * std::sin(6.0f * p.y) * std::sin(8.0f * p.z + 2.0f);
        const float falloff = std::max(0.0f, 1.0f - glm::dot(p, p));
        return std::clamp(3.0f * wave, 0.0f, 1.0f) * falloff + 0.2f * falloff;
    });
}

/// sigma_t at a world point by plain trilinear lookup (identity transform).
inline float sigma_at(const Volume& volume, Vec3 p)
{
    return volume.density_scale *
           sample_trilinear(*volume.density, volume.density->index_from_object.point(p));
}

/// Optical depth by the midpoint rule: shares nothing with the trackers but the lookup.
inline double marched_depth(const Volume& volume, Vec3 a, Vec3 b, int steps)
{
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        const float u = (static_cast<float>(i) + 0.5f) / static_cast<float>(steps);
        sum += static_cast<double>(sigma_at(volume, a + u * (b - a)));
    }
    return sum * static_cast<double>(glm::length(b - a)) / steps;
}

}  // namespace mote::test
