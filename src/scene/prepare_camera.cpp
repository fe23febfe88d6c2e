#include "scene/prepare_camera.h"

#include <fmt/format.h>

#include "core/error.h"
#include "scene/evaluate_key.h"

namespace mote {
namespace {

struct CameraState {
    Trs world_from_camera;
    double fov;
    double focus_distance;
    double lens_radius;
};

CameraState camera_at(const CameraDescription& c, double frame)
{
    const Vec3d position = evaluate_key(c.keys, &CameraKey::position, c.position, frame);
    const Vec3d look_at = evaluate_key(c.keys, &CameraKey::look_at, c.look_at, frame);
    const Vec3d up = evaluate_key(c.keys, &CameraKey::up, c.up, frame);

    CameraState state;
    state.fov = evaluate_key(c.keys, &CameraKey::fov, c.fov, frame);
    state.lens_radius = evaluate_key(c.keys, &CameraKey::lens_radius, c.lens_radius, frame);
    state.focus_distance =
        evaluate_key(c.keys, &CameraKey::focus_distance, c.focus_distance, frame);
    if (state.focus_distance <= 0.0) state.focus_distance = glm::length(look_at - position);

    const double side = glm::length(glm::cross(up, position - look_at));
    if (!(side > 1e-9 * glm::length(up) * glm::length(position - look_at))) {
        throw Error(ExitCode::Input,
                    fmt::format("camera: at frame {} it stands on its \"look_at\" or looks along "
                                "its \"up\"; change the keyframes",
                                frame));
    }
    const Vec3d back = glm::normalize(position - look_at);
    const Vec3d right = glm::normalize(glm::cross(up, back));
    state.world_from_camera.translate = position;
    state.world_from_camera.rotate =
        glm::normalize(glm::quat_cast(glm::dmat3(right, glm::cross(back, right), back)));
    return state;
}

}  // namespace

Camera make_camera(const CameraDescription& description, const RenderDescription& render,
                   double open, double close)
{
    const CameraState middle = camera_at(description, 0.5 * (open + close));
    Camera camera;
    camera.width = render.width;
    camera.height = render.height;
    camera.tan_half_fov_y = static_cast<float>(std::tan(0.5 * glm::radians(middle.fov)));
    camera.lens_radius = static_cast<float>(middle.lens_radius);
    camera.focus_distance = static_cast<float>(middle.focus_distance);
    camera.world_from_camera.keys = {camera_at(description, open).world_from_camera};
    const bool moves = close > open && !description.keys.empty() &&
                       close > description.keys.front().frame &&
                       open < description.keys.back().frame;
    if (!moves) return camera;
    constexpr int steps = 16;  // aims turn unevenly between keys, and keys may lie inside
    for (int i = 1; i <= steps; ++i) {
        const double frame = open + (close - open) * i / steps;
        camera.world_from_camera.keys.push_back(camera_at(description, frame).world_from_camera);
    }
    return camera;
}

}  // namespace mote
