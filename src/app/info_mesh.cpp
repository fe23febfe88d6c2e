#include "app/info_mesh.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/text.h"
#include "particles/ply_header.h"
#include "scene/object_parts.h"
#include "surfaces/gltf/gltf_scene.h"
#include "surfaces/load_mesh.h"

namespace mote {
namespace {

std::string mesh_lines(const Mesh& mesh)
{
    const Bounds3& box = mesh.bounds;
    return fmt::format(
        "  triangles    {}, {} vertices{}{}\n"
        "  bounds       ({:.5g}, {:.5g}, {:.5g}) .. ({:.5g}, {:.5g}, {:.5g}) m\n",
        mesh.triangles.size(), mesh.positions.size(), mesh.normals.empty() ? "" : ", normals",
        mesh.uvs.empty() ? "" : ", texture coordinates", box.lo.x, box.lo.y, box.lo.z, box.hi.x,
        box.hi.y, box.hi.z);
}

const char* kind_name(MaterialKind kind)
{
    constexpr const char* names[] = {"diffuse", "metallic_roughness", "dielectric"};
    return names[static_cast<size_t>(kind)];
}

std::string material_line(const GltfMaterial& material)
{
    return fmt::format("material \"{}\": {}{}{}{}\n", printable(material.name),
                       kind_name(material.look.kind), material.has_pictures() ? ", textures" : "",
                       material.look.is_emissive() ? ", glows" : "",
                       material.alpha_cutoff > 0.0f ? ", cut out" : "");
}

/// First and last keyframe of all nodes [s].
std::string time_range(const GltfScene& scene)
{
    double first = 1e300;
    double last = -1e300;
    for (const GltfNode& node : scene.nodes) {
        for (const auto* track : {&node.translation, &node.rotation, &node.scale}) {
            if (!*track) continue;
            first = std::min(first, static_cast<double>((*track)->times.front()));
            last = std::max(last, static_cast<double>((*track)->times.back()));
        }
    }
    return first > last ? "none" : fmt::format("{:.4g} .. {:.4g} s", first, last);
}

std::string describe_gltf(const std::string& path)
{
    const GltfScene scene = load_gltf(path);
    std::string text = fmt::format("{}: glTF file, {} meshes of one material each, {} nodes\n",
                                   printable(path), scene.parts.size(), scene.nodes.size());
    for (size_t i = 0; i < scene.parts.size(); ++i) {
        const auto material = static_cast<size_t>(scene.parts[i].material);
        text += fmt::format("mesh {} of \"{}\"\n", i, printable(scene.materials[material].name));
        text += mesh_lines(scene.parts[i].mesh);
    }
    for (size_t i = 0; i + 1 < scene.materials.size(); ++i)
        text += material_line(scene.materials[i]);
    for (const GltfNode& node : scene.nodes) {
        if (node.camera < 0) continue;
        const GltfCamera& camera = scene.cameras[static_cast<size_t>(node.camera)];
        text += fmt::format("camera \"{}\" at node \"{}\", {:.4g} degrees\n",
                            printable(camera.name), printable(node.name), camera.fov_y);
    }
    text +=
        fmt::format("pictures     {}\nanimation    {}\n", scene.images.size(), time_range(scene));
    return text;
}

}  // namespace

std::string describe_mesh_file(const std::string& path)
{
    if (is_gltf(path)) return describe_gltf(path);
    return fmt::format("{}: mesh\n", printable(path)) + mesh_lines(load_mesh(path));
}

bool is_ply_mesh(const std::string& path)
{
    InputFile file(path);
    const PlyHeader header = read_ply_header(file);
    return std::any_of(header.elements.begin(), header.elements.end(),
                       [](const PlyElement& e) { return e.name == "face" && e.count > 0; });
}

}  // namespace mote
