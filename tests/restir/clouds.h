#pragma once

#include "support/media.h"

namespace mote::test {

inline Volume turned(Volume volume, Vec3d move)
{
    Trs& trs = volume.world_from_object.keys[0];
    trs.translate = move;
    trs.rotate = glm::normalize(Quatd(0.8, 0.3, -0.4, 0.2));
    trs.scale = Vec3d(1.0, 1.4, 0.7);
    finalize(volume);
    return volume;
}

/// Two rotated, scaled clouds that overlap, of depths about 8 and 3.
inline Media two_clouds()
{
    Volume a = clumpy_cube(48);
    a.density_scale = 16.0f;
    Volume b = clumpy_cube(30);
    b.density_scale = 6.0f;
    return {{turned(a, Vec3d(0.2, -0.3, 0.1)), turned(b, Vec3d(0.7, 0.1, -0.2))}};
}

inline Bounds3 bounds_of(const Media& media)
{
    Bounds3 bounds;
    for (const Volume& volume : media.volumes) bounds.extend(world_bounds(volume));
    return bounds;
}

/// sigma_t of all media at a world point, at mid-shutter [1/m].
inline float sigma_of(const Media& media, Vec3 x)
{
    float sum = 0.0f;
    for (const Volume& volume : media.volumes) {
        const Vec3d p = frames_at(volume, 0.5f).density.point(x);
        sum += volume.density_scale * sample_local(*volume.density, Vec3(p));
    }
    return sum;
}

}  // namespace mote::test
