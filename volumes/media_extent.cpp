#include "volumes/media_extent.h"

namespace mote {

Mat4d world_from_local(const Volume& volume, float time)
{
    const Affine affine = object_from_local(volume);
    Mat4d object(glm::dmat3(affine.linear));
    object[3] = glm::dvec4(Vec3d(affine.offset), 1.0);
    return matrix(volume.world_from_object.at(time)) * object;
}

Bounds3 local_bounds(const BrickGrid& grid)
{
    const Vec3 lo(grid.lo);
    return {grid.index_bounds.lo - lo, grid.index_bounds.hi - lo};
}

float finest_voxel(const Media& media)
{
    double finest = std::numeric_limits<double>::infinity();
    for (const Volume& volume : media.volumes) {
        if (is_void(volume)) continue;
        const Mat4d m = world_from_local(volume, cache_time);
        for (int axis = 0; axis < 3; ++axis) {
            const double edge = glm::length(Vec3d(m[axis]));
            if (edge > 0.0 && edge < finest) finest = edge;
        }
    }
    return std::isfinite(finest) ? static_cast<float>(finest) : 1.0f;
}

}  // namespace mote
