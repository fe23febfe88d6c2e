#include "volumes/volume.h"

#include <glm/gtc/matrix_transform.hpp>

#include "volumes/local_ray.h"

namespace mote {
namespace {

Mat4d to_matrix(const Affine& affine)
{
    Mat4d m(glm::dmat3(affine.linear));
    m[3] = glm::dvec4(Vec3d(affine.offset), 1.0);
    return m;
}

/// world -> local coordinates of `grid`; identity for none.
GridFrame frame_of(const BrickGrid* grid, const Mat4d& object_from_world)
{
    if (!grid) return {};
    const Mat4d m = to_matrix(grid->index_from_object) * object_from_world;
    return {glm::dmat3(m), Vec3d(m[3]) - Vec3d(grid->lo)};
}

VolumeFrames compute_frames(const Volume& volume, float time)
{
    const Mat4d object_from_world = glm::inverse(matrix(volume.world_from_object.at(time)));
    return {frame_of(volume.density.get(), object_from_world),
            frame_of(volume.emission.get(), object_from_world)};
}

Affine compute_object_from_local(const Volume& volume)
{
    if (!volume.density) return {};
    const Mat4d object_from_index = glm::inverse(to_matrix(volume.density->index_from_object));
    const Mat4d index_from_local = glm::translate(Mat4d(1.0), Vec3d(volume.density->lo));
    return to_affine(object_from_index * index_from_local);
}

void extend(Bounds3& bounds, const BrickGrid* grid, const MovingTransform& world_from_object)
{
    if (!grid || grid->index_bounds.is_empty()) return;
    const Mat4d object_from_index = glm::inverse(to_matrix(grid->index_from_object));
    // Corners move on arcs between the keys; many instants and a margin catch their bulge.
    const int instants = world_from_object.is_moving() ? 65 : 1;
    Bounds3 box;
    for (int i = 0; i < instants; ++i) {
        const float time = instants > 1 ? static_cast<float>(i) / 64.0f : 0.0f;
        const Mat4d world_from_index = matrix(world_from_object.at(time)) * object_from_index;
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3 p(corner & 1 ? grid->index_bounds.hi.x : grid->index_bounds.lo.x,
                         corner & 2 ? grid->index_bounds.hi.y : grid->index_bounds.lo.y,
                         corner & 4 ? grid->index_bounds.hi.z : grid->index_bounds.lo.z);
            box.extend(Vec3(world_from_index * glm::dvec4(Vec3d(p), 1.0)));
        }
    }
    const float margin = world_from_object.is_moving() ? 0.01f : 1e-5f;
    const Vec3 pad = margin * box.extent() + 2e-7f * glm::max(glm::abs(box.lo), glm::abs(box.hi));
    bounds.extend(Bounds3{box.lo - pad, box.hi + pad});
}

}  // namespace

void finalize(Volume& volume)
{
    volume.object_from_local = compute_object_from_local(volume);
    volume.at_rest.reset();
    if (!volume.world_from_object.is_moving()) volume.at_rest = compute_frames(volume, 0.0f);
}

VolumeFrames frames_at(const Volume& volume, float time)
{
    return volume.at_rest ? *volume.at_rest : compute_frames(volume, time);
}

Affine object_from_local(const Volume& volume)
{
    return volume.object_from_local ? *volume.object_from_local : compute_object_from_local(volume);
}

Vec3 object_point(const Volume& volume, Vec3 p, float time)
{
    if (volume.at_rest && volume.density) {
        return object_from_local(volume).point(Vec3(volume.at_rest->density.point(p)));
    }
    const Mat4d object_from_world = glm::inverse(matrix(volume.world_from_object.at(time)));
    return Vec3(object_from_world * glm::dvec4(Vec3d(p), 1.0));
}

Interval volume_interval(const Volume& volume, const Ray& ray, Interval range)
{
    if (!volume.density) return {};
    const VolumeFrames frames = frames_at(volume, ray.time);
    const LocalRay local = make_local_ray(*volume.density, frames.density, ray, range);
    if (local.misses()) return {};
    return {local.world_t(0.0f), local.world_t(local.s1)};
}

Bounds3 world_bounds(const Volume& volume)
{
    Bounds3 bounds;
    extend(bounds, volume.density.get(), volume.world_from_object);
    if (volume.emission_params.emission_scale > 0.0f) {
        extend(bounds, volume.emission.get(), volume.world_from_object);
    }
    return bounds;
}

}  // namespace mote
