#include "scene/object_parts.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "core/error.h"
#include "core/file_name.h"
#include "core/text.h"
#include "surfaces/load_mesh.h"

namespace mote {
namespace {

namespace fs = std::filesystem;

/// An object's own material, or the entry that it names.
const MaterialDescription& material_of(const SceneDescription& description,
                                       const ObjectDescription& object)
{
    if (object.material.name.empty()) return object.material;
    const auto& list = description.materials;
    const auto found = std::find_if(list.begin(), list.end(), [&](const auto& material) {
        return material.name == object.material.name;
    });
    MOTE_ASSERT(found != list.end());  // check_scene
    return *found;
}

/// Whether alpha is 1 at all texels.
bool is_opaque(const Texture& texture)
{
    for (int y = 0; y < texture.height(); ++y) {
        for (int x = 0; x < texture.width(); ++x) {
            const Vec2 centre(
                (static_cast<float>(x) + 0.5f) / static_cast<float>(texture.width()),
                (static_cast<float>(y) + 0.5f) / static_cast<float>(texture.height()));
            if (texture.at(centre).w < 0.999f) return false;  // but for rounding
        }
    }
    return true;
}

/// The mesh of a file, from the cache if it is there.
std::shared_ptr<const MeshBvh> get_mesh(const PartContext& context, const ShownObject& shown)
{
    auto& mesh = context.cache.meshes[shown.version];
    if (!mesh) {
        mesh = std::make_shared<const MeshBvh>(load_mesh(shown.path));
        ++context.stats.meshes_built;
    }
    return mesh;
}

}  // namespace

MovingTransform placement(const std::vector<TransformKey>& keys, bool is_emissive, double open,
                          double close)
{
    if (!is_emissive) return over_shutter(keys, open, close);
    return MovingTransform{{evaluate(keys, 0.5 * (open + close))}};
}

MaterialTextures make_textures(const PartContext& context, const MaterialFiles& files)
{
    const auto get = [&](const std::string& file, TextureRole role) {
        if (file.empty()) return std::shared_ptr<const Texture>();
        const std::string path = (fs::path(context.description.base_dir) / file).string();
        return context.cache.textures.get({path, {}}, file_version(path), role);
    };
    MaterialTextures out;
    const size_t held = context.cache.textures.size();
    out.color = get(files.color, TextureRole::Color);
    const bool is_new = context.cache.textures.size() > held;
    out.roughness = get(files.roughness, TextureRole::Data);
    out.metallic = get(files.metallic, TextureRole::Data);
    out.normal = get(files.normal, TextureRole::Data);
    out.emission = get(files.emission, TextureRole::Color);
    out.normal_strength = files.normal_strength;
    out.alpha_cutoff = files.alpha_cutoff;
    if (out.is_cut() && out.color && is_new && is_opaque(*out.color)) {
        spdlog::warn(
            "{}: has no alpha, so \"alpha_cutoff\" cuts nothing out of it; save it with "
            "an alpha channel",
            printable(files.color));
    }
    return out;
}

bool is_gltf(const std::string& path)
{
    const std::string extension = lower_extension(path);
    return extension == ".gltf" || extension == ".glb";
}

SurfaceLook make_look(const PartContext& context, const ObjectDescription& object)
{
    const MaterialDescription& from = material_of(context.description, object);
    SurfaceLook look{from.look, make_textures(context, from.files)};
    look.material.emission = from.emission * from.emission_color;
    return look;
}

void require_uvs(const MeshBvh& mesh, const MaterialTextures& textures, const std::string& file)
{
    if (!textures.has_pictures() || !mesh.mesh().uvs.empty()) return;
    throw Error(ExitCode::Input,
                fmt::format("{}: the mesh has no texture coordinates, but its material has "
                            "textures; unwrap it (OBJ: vt, PLY: s and t), or use a material "
                            "without textures",
                            printable(file)));
}

void add_mesh_part(const PartContext& context, const ShownObject& shown,
                   std::vector<ObjectPart>& parts)
{
    const auto& [frame, open, close] = context.times;
    ObjectPart part{
        shown.name, get_mesh(context, shown), make_look(context, *shown.object), {}, {}};
    require_uvs(*part.mesh, part.look.textures, shown.path);
    const auto& keys = shown.object->transform;
    const bool is_emissive = part.look.material.is_emissive();
    part.world_from_object = placement(keys, is_emissive, open, close);
    part.next = placement(keys, is_emissive, open + 1.0, close + 1.0);
    parts.push_back(std::move(part));
}

}  // namespace mote
