#include <map>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "core/text.h"
#include "surfaces/gltf/gltf_convert.h"

namespace mote {
namespace {

template <class Vector>
void assign(const GltfSource& source, const std::vector<double>& from, size_t size, Vector&& set)
{
    if (from.empty()) return;
    if (from.size() != size) {
        source.fail(
            fmt::format("a node's transform has {} numbers in place of {}", from.size(), size));
    }
    for (const double value : from) {
        if (!std::isfinite(value)) source.fail("a node's transform is not finite");
    }
    set(from);
}

void convert_transform(const GltfSource& source, const tinygltf::Node& from, GltfNode& out)
{
    assign(source, from.translation, 3,
           [&](const auto& v) { out.trs.translate = Vec3d(v[0], v[1], v[2]); });
    assign(source, from.scale, 3, [&](const auto& v) { out.trs.scale = Vec3d(v[0], v[1], v[2]); });
    assign(source, from.rotation, 4, [&](const auto& v) {
        const Quatd q(v[3], v[0], v[1], v[2]);
        if (glm::length(q) > 1e-9) out.trs.rotate = glm::normalize(q);
    });
    assign(source, from.matrix, 16, [&](const auto& v) {
        Mat4d matrix(1.0);
        for (size_t i = 0; i < 16; ++i) {
            matrix[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = v[i];
        }
        out.matrix = matrix;
    });
}

/// The roots of what the file shows.
std::vector<int> roots_of(const GltfSource& source)
{
    const tinygltf::Model& model = source.model;
    if (!model.scenes.empty()) {
        const int scene = model.defaultScene >= 0 ? model.defaultScene : 0;
        return source.at(model.scenes, scene, "scene").nodes;
    }
    std::vector<bool> is_child(model.nodes.size(), false);
    for (const tinygltf::Node& node : model.nodes) {
        for (const int child : node.children) {
            (void)source.at(model.nodes, child, "node");
            is_child[static_cast<size_t>(child)] = true;
        }
    }
    std::vector<int> roots;
    for (size_t i = 0; i < is_child.size(); ++i) {
        if (!is_child[i]) roots.push_back(static_cast<int>(i));
    }
    return roots;
}

void convert_cameras(const GltfSource& source, GltfScene& out)
{
    for (const tinygltf::Camera& from : source.model.cameras) {
        GltfCamera camera{from.name, glm::degrees(from.perspective.yfov)};
        // Orthographic ones are refused where they are used.
        if (from.type != "perspective") camera.fov_y = 0.0;
        out.cameras.push_back(std::move(camera));
    }
}

constexpr int max_depth = 1000;
constexpr size_t max_placed = 10'000'000;

}  // namespace

void convert_nodes(const GltfSource& source, const std::vector<GltfUvChoice>& uvs, GltfScene& out)
{
    const tinygltf::Model& model = source.model;
    convert_cameras(source, out);
    std::vector<int> node_of(model.nodes.size(), -1);
    std::map<int, std::vector<int>> parts_of_mesh;
    struct Pending {
        int node;
        int parent;
        int depth;
    };
    size_t placed = 0;
    std::vector<Pending> pending;
    const std::vector<int> roots = roots_of(source);
    for (size_t i = roots.size(); i-- > 0;) pending.push_back({roots[i], -1, 0});
    bool has_skins = false;
    while (!pending.empty()) {
        const Pending next = pending.back();
        pending.pop_back();
        const tinygltf::Node& from = source.at(model.nodes, next.node, "node");
        int& place = node_of[static_cast<size_t>(next.node)];
        if (place >= 0) {
            source.fail(fmt::format("node {} is its own ancestor or has two parents", next.node));
        }
        place = static_cast<int>(out.nodes.size());
        if (next.depth > max_depth) {
            source.fail(fmt::format("its nodes are nested more than {} deep", max_depth));
        }
        GltfNode node;
        node.name = from.name;
        node.parent = next.parent;
        convert_transform(source, from, node);
        if (from.mesh >= 0) {
            auto found = parts_of_mesh.find(from.mesh);
            if (found == parts_of_mesh.end()) {
                found = parts_of_mesh.emplace(from.mesh, convert_mesh(source, from.mesh, uvs, out))
                            .first;
            }
            node.parts = found->second;
            placed += node.parts.size();
            if (placed > max_placed) {
                source.fail(fmt::format("it places more than {} meshes", max_placed));
            }
        }
        if (from.camera >= 0) {
            (void)source.at(model.cameras, from.camera, "camera");
            node.camera = from.camera;
        }
        has_skins |= from.skin >= 0;
        for (size_t i = from.children.size(); i-- > 0;) {
            pending.push_back({from.children[i], place, next.depth + 1});
        }
        out.nodes.push_back(std::move(node));
    }
    if (has_skins) {
        spdlog::warn("{}: skins are not shown; meshes keep the shape they were made in",
                     printable(source.path));
    }
    convert_animations(source, node_of, out);
}

}  // namespace mote
