#pragma once

#include "volumes/volume.h"

namespace mote {

/// A ray in the local coordinates of one grid, cut to the part inside the grid's bounds and
/// re-based to where that part starts, so that floats suffice from here on. World distance
/// t = t0 + s; d is voxels per metre, not a unit vector.
struct LocalRay {
    Vec3 o{0.0f};
    Vec3 d{0.0f};
    float s1 = -1.0f;  ///< s runs over [0, s1]; not above 0: the ray misses
    double t0 = 0.0;   ///< world distance of s = 0 [m]

    [[nodiscard]] bool misses() const { return !(s1 > 0.0f); }
    [[nodiscard]] Vec3 at(float s) const { return o + s * d; }
    [[nodiscard]] float world_t(float s) const
    {
        return static_cast<float>(t0 + static_cast<double>(s));
    }
};

/// Clips a world ray to a grid. Zero direction components, rays that start inside, and infinite
/// ranges are fine; NaN misses.
[[nodiscard]] inline LocalRay make_local_ray(const BrickGrid& grid, const GridFrame& frame,
                                             const Ray& ray, Interval range)
{
    LocalRay out;
    const Vec3d o = frame.point(ray.o);
    const Vec3d d = frame.vector(ray.d);
    double t0 = static_cast<double>(range.t0);
    double t1 = static_cast<double>(range.t1);
    for (int axis = 0; axis < 3; ++axis) {
        const double lo = static_cast<double>(grid.index_bounds.lo[axis]) - grid.lo[axis];
        const double hi = static_cast<double>(grid.index_bounds.hi[axis]) - grid.lo[axis];
        if (std::abs(d[axis]) < 1e-30) {
            if (!(o[axis] >= lo && o[axis] <= hi)) return out;
            continue;
        }
        const double inv = 1.0 / d[axis];
        const double a = (lo - o[axis]) * inv;
        const double b = (hi - o[axis]) * inv;
        t0 = std::max(t0, std::min(a, b));
        t1 = std::min(t1, std::max(a, b));
    }
    if (!(t0 < t1) || !(t1 - t0 < 1e30)) return out;
    out.o = Vec3(o + t0 * d);
    out.d = Vec3(d);
    out.s1 = static_cast<float>(t1 - t0);
    out.t0 = t0;
    return out;
}

/// A world ray in the density grid of a volume that is not void, at the ray's time.
[[nodiscard]] inline LocalRay density_ray(const Volume& volume, const Ray& ray, Interval range)
{
    if (volume.at_rest) return make_local_ray(*volume.density, volume.at_rest->density, ray, range);
    return make_local_ray(*volume.density, frames_at(volume, ray.time).density, ray, range);
}

}  // namespace mote
