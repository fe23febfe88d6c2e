#include <algorithm>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "core/text.h"
#include "surfaces/gltf/gltf_convert.h"
#include "surfaces/load_mesh.h"

namespace mote {
namespace {

/// Appends the triangles of a list of vertices that is read in the primitive's mode.
void add_triangles(const std::vector<uint32_t>& v, int mode, Mesh& mesh)
{
    const size_t n = v.size();
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        for (size_t i = 0; i + 2 < n; i += 3) mesh.triangles.emplace_back(v[i], v[i + 1], v[i + 2]);
    } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
        for (size_t i = 0; i + 2 < n; ++i) {
            const size_t odd = i % 2;
            mesh.triangles.emplace_back(v[i], v[i + 1 + odd], v[i + 2 - odd]);
        }
    } else {
        add_polygon(mesh, v);
    }
}

std::vector<Vec2> convert_uvs(const std::vector<glm::vec4>& from, const GltfUvChoice& choice)
{
    std::vector<Vec2> out;
    out.reserve(from.size());
    for (const glm::vec4& uv : from) {
        const Vec3 turned = choice.from_file * Vec3(uv.x, uv.y, 1.0f);
        out.emplace_back(turned.x, 1.0f - turned.y);  // glTF's v runs downwards
    }
    return out;
}

/// The vertices that a primitive lists, in the order of its mode.
std::vector<uint32_t> read_list(const GltfSource& source, const tinygltf::Primitive& primitive,
                                size_t vertex_count)
{
    std::vector<uint32_t> list;
    if (primitive.indices >= 0) {
        list = read_indices(source, primitive.indices);
    } else {
        list.resize(vertex_count);
        for (size_t i = 0; i < list.size(); ++i) list[i] = static_cast<uint32_t>(i);
    }
    for (const uint32_t vertex : list) {
        if (vertex < vertex_count) continue;
        source.fail(
            fmt::format("a triangle uses vertex {}, but there are only {}", vertex, vertex_count));
    }
    return list;
}

/// Renumbers the vertices of a list by their rank, and returns them in ascending order: what a
/// primitive uses of accessors that many may share.
std::vector<uint32_t> compact(std::vector<uint32_t>& list)
{
    std::vector<uint32_t> used = list;
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (uint32_t& vertex : list) {
        const auto rank = std::lower_bound(used.begin(), used.end(), vertex) - used.begin();
        vertex = static_cast<uint32_t>(rank);
    }
    return used;
}

/// A primitive of triangles, unfinished.
Mesh read_primitive(const GltfSource& source, const tinygltf::Primitive& primitive,
                    const GltfUvChoice& choice)
{
    const auto attribute = [&](const std::string& name) {
        const auto found = primitive.attributes.find(name);
        return found == primitive.attributes.end() ? -1 : found->second;
    };
    const int position = attribute("POSITION");
    const size_t count = std::min(element_count(source, position), total_bytes(source.model));
    std::vector<uint32_t> list = read_list(source, primitive, count);
    const std::vector<uint32_t> used = compact(list);
    Mesh mesh;
    for (const glm::vec4& p : read_some_vectors(source, position, 3, "positions", used)) {
        mesh.positions.emplace_back(p);
    }
    if (const int accessor = attribute("NORMAL"); accessor >= 0) {
        for (const glm::vec4& n : read_some_vectors(source, accessor, 3, "normals", used)) {
            mesh.normals.emplace_back(n);
        }
    }
    if (const int accessor = attribute(fmt::format("TEXCOORD_{}", choice.set)); accessor >= 0) {
        mesh.uvs = convert_uvs(read_some_vectors(source, accessor, 2, "texture coordinates", used),
                               choice);
    }
    add_triangles(list, primitive.mode, mesh);
    return mesh;
}

/// Throws if the parts hold more than the file can mean: every corner is at least a byte of it, but
/// for data that several primitives share.
void check_size(const GltfSource& source, const GltfScene& scene)
{
    if (scene.corner_count / 256 > total_bytes(source.model) + 1000) {
        source.fail("its meshes use the same data too often to be meant");
    }
}

}  // namespace

std::vector<int> convert_mesh(const GltfSource& source, int index,
                              const std::vector<GltfUvChoice>& uvs, GltfScene& out)
{
    const tinygltf::Mesh& mesh = source.at(source.model.meshes, index, "mesh");
    const std::string name =
        mesh.name.empty() ? fmt::format("{}", index) : fmt::format("\"{}\"", printable(mesh.name));
    std::vector<int> parts;
    int left_out = 0;
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
        const bool is_surface = primitive.mode >= TINYGLTF_MODE_TRIANGLES &&
                                primitive.mode <= TINYGLTF_MODE_TRIANGLE_FAN;
        if (!is_surface) {
            ++left_out;
            continue;
        }
        GltfPart part;
        part.material = static_cast<int>(uvs.size()) - 1;
        if (primitive.material >= 0) {
            (void)source.at(source.model.materials, primitive.material, "material");
            part.material = primitive.material;
        }
        part.mesh = read_primitive(source, primitive, uvs[static_cast<size_t>(part.material)]);
        const std::string place = fmt::format("{}: mesh {}", printable(source.path), name);
        const MeshRepairs repairs = repair_mesh(part.mesh, place);
        warn_of_repairs(repairs, place);
        if (part.mesh.triangles.empty()) {
            ++left_out;
            continue;
        }
        if (part.mesh.uvs.empty() &&
            out.materials[static_cast<size_t>(part.material)].has_pictures()) {
            spdlog::warn("{} has no texture coordinates; shown without pictures", place);
        }
        parts.push_back(static_cast<int>(out.parts.size()));
        out.corner_count += 3 * part.mesh.triangles.size();
        check_size(source, out);
        out.parts.push_back(std::move(part));
    }
    if (left_out > 0) {
        spdlog::warn("{}: mesh {}: left out {} parts without triangles (lines, points)",
                     printable(source.path), name, left_out);
    }
    return parts;
}

}  // namespace mote
