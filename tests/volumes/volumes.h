#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "core/stats.h"
#include "volumes/tracking.h"

namespace mote::test {

/// Dense bricks of a function of the voxel coordinates.
inline std::shared_ptr<const BrickGrid> bricks_of(Vec3i size, const Affine& index_from_object,
                                                  const std::function<float(Vec3i)>& f)
{
    std::vector<float> values;
    for (int x = 0; x < size.x; ++x) {
        for (int y = 0; y < size.y; ++y) {
            for (int z = 0; z < size.z; ++z) values.push_back(f({x, y, z}));
        }
    }
    return make_dense_bricks(size, values, index_from_object);
}

/// Sparse bumpy density in [0,1] with empty regions and a constant core.
inline float bumpy(Vec3i p)
{
    const Vec3 x = Vec3(p) * 0.31f;
    if (p.x > 24 && p.x < 44 && p.y > 20 && p.y < 44 && p.z > 20 && p.z < 44) return 0.75f;
    const float v = std::sin(x.x) * std::cos(1.3f * x.y) + std::sin(0.7f * x.z + x.x);
    return std::max(0.0f, 0.5f * v - 0.2f);
}

inline Volume volume_of(std::shared_ptr<const BrickGrid> bricks, float density_scale,
                        const MovingTransform& transform = {})
{
    Volume volume;
    volume.name = "test";
    volume.density = std::move(bricks);
    volume.density_scale = density_scale;
    volume.world_from_object = transform;
    finalize(volume);
    return volume;
}

/// A non-trivial transform: rotation, non-uniform scale, translation.
inline MovingTransform tilted(double scale = 1.0)
{
    Trs trs;
    trs.translate = Vec3d(0.3, -0.2, 0.5) * scale;
    trs.rotate = glm::normalize(Quatd(0.8, 0.3, -0.4, 0.2));
    trs.scale = Vec3d(1.0, 1.7, 0.6) * scale;
    return {{trs}};
}

/// Object space: one voxel is 1/64 of a metre, a 64^3 grid fills about the unit cube.
inline Affine unit_cube()
{
    return {Mat3(64.0f), Vec3(0.0f)};
}

inline constexpr Interval everything{0.0f, infinity};

inline std::shared_ptr<const BrickGrid> bumpy_bricks()
{
    static const auto grid = bricks_of({64, 64, 64}, unit_cube(), bumpy);
    return grid;
}

/// Constant density 1 in a box whose optical depth along x is exactly `tau` (reconstruction
/// included: n voxels of width h integrate to n h).
inline Volume slab(float tau)
{
    const auto grid = bricks_of({64, 64, 64}, unit_cube(), [](Vec3i) { return 1.0f; });
    return volume_of(grid, tau);
}

inline const Ray along_x{{-3.0f, 0.51f, 0.47f}, {1.0f, 0.0f, 0.0f}};

/// Ray number `i` of a fixed set through the neighbourhood of `bounds`.
inline Ray test_ray(const Bounds3& bounds, uint32_t i)
{
    Rng rng(7, 0, Stream::Test, i, 1);
    const Vec3 size = bounds.extent();
    const Vec3 from = bounds.lo + size * (rng.uniform3() * 3.0f - Vec3(1.0f));
    const Vec3 to = bounds.lo + size * rng.uniform3();
    return {from, glm::normalize(to - from), rng.uniform()};
}

/// Optical depth by brute force: midpoints of `steps` pieces of the range, looked up in double
/// position. Error of second order in the step.
inline double marched_depth(const Volume& volume, const Ray& ray, Interval range, int steps)
{
    const Mat4d object_from_world = glm::inverse(matrix(volume.world_from_object.at(ray.time)));
    const double length = static_cast<double>(range.t1) - static_cast<double>(range.t0);
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        const double t = static_cast<double>(range.t0) + length * (i + 0.5) / steps;
        const Vec3d p = Vec3d(ray.o) + t * Vec3d(ray.d);
        const glm::dvec4 q = object_from_world * glm::dvec4(p, 1.0);
        sum += static_cast<double>(sigma_t_at(volume, Vec3(q)));
    }
    return sum * length / steps;
}

/// |mean - exact| within 5 standard errors: false alarm once in 1.7 million seeds per comparison.
inline void expect_mean(const RunningStats& stats, double exact, const char* what)
{
    EXPECT_LT(std::abs(stats.mean - exact), 5.0 * stats.standard_error() + 1e-6 * exact)
        << what << ": " << stats.mean << " +- " << stats.standard_error() << ", exact " << exact;
}

}  // namespace mote::test
