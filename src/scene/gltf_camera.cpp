#include "scene/gltf_camera.h"

#include <filesystem>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "scene/matrix_motion.h"
#include "scene/object_parts.h"

namespace mote {
namespace {

/// The node that holds the camera of this name, or the first one that holds any.
int find_camera(const LoadedGltf& file, const std::string& name)
{
    const GltfScene& scene = file.scene;
    std::vector<std::string> names;
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const GltfNode& node = scene.nodes[i];
        if (node.camera < 0) continue;
        const GltfCamera& camera = scene.cameras[static_cast<size_t>(node.camera)];
        if (name.empty() || name == camera.name || name == node.name) return static_cast<int>(i);
        names.push_back(node.name.empty() ? camera.name : node.name);
    }
    if (name.empty()) {
        throw Error(ExitCode::Input, fmt::format("{}: has no camera; export it with one, or set "
                                                 "the camera's position and look_at",
                                                 printable(file.path)));
    }
    throw Error(ExitCode::Input, fmt::format("{}: has no camera \"{}\"{}", printable(file.path),
                                             printable(name), did_you_mean(name, names)));
}

}  // namespace

Camera make_gltf_camera(const SceneDescription& scene, GltfCache& cache, double open, double close)
{
    const CameraDescription& description = scene.camera;
    const std::string path =
        (std::filesystem::path(scene.base_dir) / description.file.path).string();
    if (!is_gltf(path)) {
        throw Error(ExitCode::Input, fmt::format("{}: the camera's file must be glTF (.gltf, .glb)",
                                                 printable(path)));
    }
    const LoadedGltf& file = cache.get(path);
    const int node = find_camera(file, description.file.name);
    const int index = file.scene.nodes[static_cast<size_t>(node)].camera;
    const double fov = file.scene.cameras[static_cast<size_t>(index)].fov_y;
    if (!(fov > 0.01 && fov < 179.0)) {
        throw Error(ExitCode::Input,
                    fmt::format("{}: its camera is orthographic or has no field of view that mote "
                                "can show (0.01 to 179 degrees)",
                                printable(path)));
    }
    const auto matrix_at = [&](double frame) {
        return world_from_node(file.scene, node, frame / scene.fps);
    };
    constexpr int steps = 16;
    std::optional<MovingTransform> motion = matrix_motion(matrix_at, open, close, steps);
    if (!motion) {
        throw Error(ExitCode::Input,
                    fmt::format("{}: its camera is sheared or scaled to nothing", printable(path)));
    }
    for (Trs& key : motion->keys) key.scale = Vec3d(1.0);
    Camera camera;
    camera.width = scene.render.width;
    camera.height = scene.render.height;
    camera.tan_half_fov_y = static_cast<float>(std::tan(0.5 * glm::radians(fov)));
    camera.lens_radius = static_cast<float>(description.lens_radius);
    camera.focus_distance =
        static_cast<float>(description.focus_distance > 0.0 ? description.focus_distance : 1.0);
    camera.world_from_camera = std::move(*motion);
    return camera;
}

}  // namespace mote
