#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "scene/matrix_motion.h"
#include "scene/object_parts.h"

namespace mote {
namespace {

/// Keys over the shutter where something is animated; turns of less than 90 degrees between them
/// are exact to a thousandth.
constexpr int motion_steps = 16;

/// One mesh of one node, under placement.
struct Placing {
    const PartContext& context;
    const ShownObject& shown;
    LoadedGltf& file;
    int node = 0;
    int part = 0;

    [[nodiscard]] const GltfNode& at() const { return file.scene.nodes[static_cast<size_t>(node)]; }
    [[nodiscard]] Mat4d world(double frame) const;
    [[nodiscard]] bool moves() const
    {
        return is_animated(file.scene, node) || shown.object->transform.size() > 1;
    }
    [[nodiscard]] std::shared_ptr<const MeshBvh> mesh() const;
    [[nodiscard]] std::shared_ptr<const MeshBvh> sheared_mesh(const Mat4d& matrix) const;
    [[nodiscard]] SurfaceLook look() const;
    [[nodiscard]] std::optional<MovingTransform> motion(bool is_emissive, double open,
                                                        double close) const;
};

Mat4d Placing::world(double frame) const
{
    Mat4d world = matrix(evaluate(shown.object->transform, frame)) *
                  world_from_node(file.scene, node, frame / context.description.fps);
    for (int c = 0; c < 4; ++c) {
        const double largest = glm::length(Vec3d(world[c]));
        if (largest < 1e9) continue;
        throw Error(ExitCode::Input, fmt::format("{}: node \"{}\" is placed or scaled beyond 1e9 m",
                                                 printable(file.path), printable(at().name)));
    }
    return world;
}

std::shared_ptr<const MeshBvh> Placing::mesh() const
{
    auto& mesh = file.meshes[static_cast<size_t>(part)];
    if (!mesh) {
        Mesh& source = file.scene.parts[static_cast<size_t>(part)].mesh;
        mesh = std::make_shared<const MeshBvh>(std::move(source));
        ++context.stats.meshes_built;
    }
    return mesh;
}

/// A copy of the mesh with the matrix applied: for what no scale, rotation and shift can place.
std::shared_ptr<const MeshBvh> Placing::sheared_mesh(const Mat4d& matrix) const
{
    std::string key = fmt::format("{}", part);
    for (int c = 0; c < 4; ++c) {
        for (int r = 0; r < 3; ++r) key += fmt::format(" {}", matrix[c][r]);
    }
    auto& held = file.sheared[key];
    if (held) return held;
    Mesh copy = mesh()->mesh();
    const glm::dmat3 linear(matrix);
    const glm::dmat3 inverse = glm::inverse(linear);
    for (Vec3& p : copy.positions) p = Vec3(linear * Vec3d(p) + Vec3d(matrix[3]));
    for (Vec3& n : copy.normals) n = Vec3(Vec3d(n) * inverse);
    if (glm::determinant(linear) < 0.0) {
        for (glm::uvec3& t : copy.triangles) std::swap(t.y, t.z);
    }
    finish_mesh(copy, file.path);
    held = std::make_shared<const MeshBvh>(std::move(copy));
    ++context.stats.meshes_built;
    return held;
}

SurfaceLook Placing::look() const
{
    if (shown.object->has_material) return make_look(context, *shown.object);
    const GltfPart& from = file.scene.parts[static_cast<size_t>(part)];
    const GltfMaterial& material = file.scene.materials[static_cast<size_t>(from.material)];
    SurfaceLook look{material.look, {}};
    look.textures.opacity = material.opacity;
    look.textures.alpha_cutoff = material.alpha_cutoff;
    look.textures.normal_strength = material.normal_strength;
    if (mesh()->mesh().uvs.empty()) return look;  // load_gltf has warned
    const auto get = [&](const GltfPicture& use, TextureRole role) {
        if (use.image < 0) return std::shared_ptr<const Texture>();
        const GltfImage& picture = file.scene.images[static_cast<size_t>(use.image)];
        const std::string version = picture.bytes.empty()
                                        ? file_version(picture.path)
                                        : fmt::format("{} image {}", file.version, use.image);
        return context.cache.textures.get({picture.path, picture.bytes}, version, role,
                                          use.sampler);
    };
    const auto named = [&](const GltfPicture& use, TextureRole role) {
        try {
            return get(use, role);
        } catch (const Error& error) {
            throw Error(error.code(), fmt::format("{}: material \"{}\": {}", printable(file.path),
                                                  printable(material.name), error.what()));
        }
    };
    look.textures.color = named(material.color, TextureRole::Color);
    look.textures.roughness = named(material.metallic_roughness, TextureRole::Data);
    look.textures.metallic = look.textures.roughness;
    look.textures.normal = named(material.normal, TextureRole::Data);
    look.textures.emission = named(material.emission, TextureRole::Color);
    return look;
}

std::optional<MovingTransform> Placing::motion(bool is_emissive, double open, double close) const
{
    const double middle = 0.5 * (open + close);
    if (is_emissive || !moves()) open = close = middle;
    // As fine as the scene's own keyframes ask for.
    const size_t keys = over_shutter(shown.object->transform, open, close).keys.size();
    const int steps = std::max(motion_steps, static_cast<int>(keys) - 1);
    return matrix_motion([&](double frame) { return world(frame); }, open, close, steps);
}

/// Without a picture a cut takes all or nothing. Whether anything is left.
bool settle_cut(MaterialTextures& textures)
{
    if (!textures.is_cut() || textures.color) return true;
    const bool is_left = is_present(textures, Vec2(0.0f));
    textures.alpha_cutoff = 0.0f;
    return is_left;
}

void add_part(const Placing& placing, std::vector<ObjectPart>& parts)
{
    const auto& [frame, open, close] = placing.context.times;
    SurfaceLook look = placing.look();
    if (!settle_cut(look.textures)) return;
    const Mat4d middle = placing.world(0.5 * (open + close));
    if (is_flat(middle)) return;  // scaled to nothing: how animations hide things
    const std::string name = placing.at().name.empty()
                                 ? fmt::format("{}/{}", placing.shown.name, placing.node)
                                 : fmt::format("{}/{}", placing.shown.name, placing.at().name);
    ObjectPart part{name, nullptr, std::move(look), {}, {}};
    const bool is_emissive = part.look.material.is_emissive();
    const auto now = placing.motion(is_emissive, open, close);
    if (now) {
        part.mesh = placing.mesh();
        part.world_from_object = *now;
        part.next = placing.motion(is_emissive, open + 1.0, close + 1.0).value_or(*now);
    } else if (!placing.moves()) {
        part.mesh = placing.sheared_mesh(middle);
    } else {
        throw Error(ExitCode::Input,
                    fmt::format("{}: node \"{}\" moves and is sheared, by a rotation below a scale "
                                "that is not even, or shrinks to nothing while the shutter is "
                                "open; apply the scale where it was made",
                                printable(placing.file.path), printable(placing.at().name)));
    }
    if (placing.shown.object->has_material) {
        require_uvs(*part.mesh, part.look.textures, placing.file.path);
    }
    parts.push_back(std::move(part));
}

}  // namespace

void add_gltf_parts(const PartContext& context, const ShownObject& shown,
                    std::vector<ObjectPart>& parts)
{
    LoadedGltf& file = context.cache.gltfs.get(shown.path);
    const size_t before = parts.size();
    for (size_t i = 0; i < file.scene.nodes.size(); ++i) {
        for (const int part : file.scene.nodes[i].parts) {
            add_part({context, shown, file, static_cast<int>(i), part}, parts);
        }
    }
    if (parts.size() == before && file.scene.parts.empty()) {
        throw Error(ExitCode::Input,
                    fmt::format("{}: holds no triangle that can be drawn", printable(shown.path)));
    }
}

}  // namespace mote
