#include "render/motion.h"

namespace mote {
namespace {

/// World position one frame later of the media particles at world point p.
Vec3 next_position(const Scene& scene, Vec3 p, float time)
{
    glm::dvec3 sum(0.0);
    double weight = 0.0;
    for (size_t i = 0; i < scene.media.volumes.size(); ++i) {
        const Volume& volume = scene.media.volumes[i];
        const Mat4d world_from_object = matrix(volume.world_from_object.at(time));
        const Vec3 p_object(glm::inverse(world_from_object) * glm::dvec4(Vec3d(p), 1.0));
        const auto sigma_t = static_cast<double>(sigma_t_at(volume, p_object));
        if (!(sigma_t > 0.0)) continue;
        const Vec3d step = Vec3d(velocity_at(volume, p_object)) / scene.fps;
        const Mat4d next_world_from_object =
            scene.next ? matrix(scene.next->world_from_object[i].at(time)) : world_from_object;
        sum += sigma_t * Vec3d(next_world_from_object * glm::dvec4(Vec3d(p_object) + step, 1.0));
        weight += sigma_t;
    }
    return weight > 0.0 ? Vec3(sum / weight) : p;
}

/// The same of the object's point at world point p.
Vec3 next_surface_position(const Scene& scene, int object, Vec3 p, float time)
{
    if (!scene.next) return p;
    const auto i = static_cast<size_t>(object);
    const InstanceFrame now = scene.surfaces->bvh->frame_at(i, time);
    const Vec3d p_object = now.inverse * (Vec3d(p) - now.offset);
    const Mat4d next = matrix(scene.next->world_from_surface[i].at(time));
    return Vec3(next * glm::dvec4(p_object, 1.0));
}

}  // namespace

Vec2 film_motion(const Scene& scene, const Ray& ray, float distance, int object)
{
    const Camera& next_camera = scene.next ? scene.next->camera : scene.camera;
    const bool is_background = !(distance < infinity);
    constexpr float far_away = 1e6f;  // [m]: no parallax, and floats still tell 1e-4 pixels apart
    const Vec3 p = ray.at(is_background ? far_away : distance);
    const Vec3 p_next = is_background ? p
                        : object >= 0 ? next_surface_position(scene, object, p, ray.time)
                                      : next_position(scene, p, ray.time);
    const std::optional<Vec2> now = project(scene.camera, p, ray.time);
    const std::optional<Vec2> next = project(next_camera, p_next, ray.time);
    if (!now || !next) return Vec2(0.0f);
    return {next->x - now->x, now->y - next->y};
}

}  // namespace mote
