#include "render/metadata.h"

#include <glm/gtc/type_ptr.hpp>

namespace mote {
namespace {

/// Column-major for column vectors is row-major for row vectors: the memory order agrees.
std::vector<float> values_of(const Mat4d& m)
{
    const glm::mat4 values(m);
    const float* begin = glm::value_ptr(values);
    return {begin, begin + 16};
}

}  // namespace

std::vector<Attribute> camera_attributes(const Camera& camera)
{
    Trs pose = camera.world_from_camera.at(0.0f);
    pose.scale = Vec3d(1.0);
    Mat4d flip_z(1.0);
    flip_z[2][2] = -1.0;
    const Mat4d camera_from_world = flip_z * glm::inverse(matrix(pose));

    const double half_height = static_cast<double>(camera.tan_half_fov_y);
    const double half_width = half_height * camera.width / camera.height;
    Mat4d ndc_from_camera(0.0);  // columns; the last row divides by z
    ndc_from_camera[0][0] = 0.5 / half_width;
    ndc_from_camera[1][1] = -0.5 / half_height;
    ndc_from_camera[2] = {0.5, 0.5, 1.0, 1.0};
    return {{"worldToCamera", values_of(camera_from_world)},
            {"worldToNDC", values_of(ndc_from_camera * camera_from_world)},
            {"chromaticities",
             std::vector<float>{0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f}}};
}

}  // namespace mote
