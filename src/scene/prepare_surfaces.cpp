#include "scene/prepare_surfaces.h"

#include <algorithm>

#include <fmt/format.h>

#include "particles/sequence.h"
#include "scene/object_parts.h"
#include "scene/object_reach.h"
#include "scene/surface_lights.h"

namespace mote {
namespace {

std::vector<ShownObject> shown_objects(const SceneDescription& description, int frame)
{
    std::vector<ShownObject> shown;
    for (size_t i = 0; i < description.objects.size(); ++i) {
        const ObjectDescription& object = description.objects[i];
        const auto path = resolve_sequence(object.file, frame, description.base_dir);
        if (!path) continue;
        const std::string name = object.name.empty() ? fmt::format("object {}", i) : object.name;
        shown.push_back({&object, name, *path, file_version(*path)});
    }
    return shown;
}

/// Drops meshes that the frame does not show, before it loads new ones.
void drop_hidden(const std::vector<ShownObject>& shown, SceneCache::Impl& cache)
{
    std::set<std::string> wanted;
    for (const ShownObject& s : shown) wanted.insert(s.version);
    for (auto it = cache.meshes.begin(); it != cache.meshes.end();) {
        it = wanted.count(it->first) ? std::next(it) : cache.meshes.erase(it);
    }
}

bool is_same(const std::vector<MeshInstance>& a, const std::vector<MeshInstance>& b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const MeshInstance& p, const MeshInstance& q) {
                          return p.mesh == q.mesh && p.world_from_object == q.world_from_object;
                      });
}

std::vector<ObjectPart> make_parts(const std::vector<ShownObject>& shown,
                                   const PartContext& context)
{
    std::vector<ObjectPart> parts;
    for (const ShownObject& s : shown) {
        const size_t first = parts.size();
        is_gltf(s.path) ? add_gltf_parts(context, s, parts) : add_mesh_part(context, s, parts);
        for (size_t i = first; i < parts.size(); ++i) require_in_reach(parts[i], s.path);
    }
    return parts;
}

/// The number of a look among those that are there; equal ones are one.
int number_of(SurfaceLook&& look, std::vector<Material>& materials,
              std::vector<MaterialTextures>& textures)
{
    for (size_t i = 0; i < materials.size(); ++i) {
        if (materials[i] == look.material && textures[i] == look.textures) {
            return static_cast<int>(i);
        }
    }
    materials.push_back(look.material);
    textures.push_back(std::move(look.textures));
    return static_cast<int>(materials.size()) - 1;
}

void count_meshes(const std::vector<ObjectPart>& parts, const SceneCache::Impl& cache,
                  PrepareStats& stats)
{
    std::set<const MeshBvh*> meshes;
    for (const ObjectPart& part : parts) {
        if (!meshes.insert(part.mesh.get()).second) continue;
        stats.mesh_bytes += part.mesh->memory_bytes();
    }
    stats.meshes_reused += static_cast<int>(meshes.size()) - stats.meshes_built;
    stats.texture_bytes += cache.textures.memory_bytes();
}

}  // namespace

void prepare_surfaces(const SceneDescription& description, const ShutterTimes& times,
                      SceneCache::Impl& cache, PrepareStats& stats, Scene& scene)
{
    const std::vector<ShownObject> shown = shown_objects(description, times.frame);
    drop_hidden(shown, cache);
    if (shown.empty()) {
        cache.instances.reset();
        cache.gltfs.drop_unused();
        cache.textures.drop_unused();
        return;
    }
    std::vector<ObjectPart> parts = make_parts(shown, {description, times, cache, stats});
    cache.gltfs.drop_unused();
    cache.textures.drop_unused();
    if (parts.empty()) {
        cache.instances.reset();
        return;
    }
    count_meshes(parts, cache, stats);
    Surfaces surfaces;
    std::vector<MaterialTextures> textures;
    std::vector<MeshInstance> instances;
    for (ObjectPart& part : parts) {
        const int material = number_of(std::move(part.look), surfaces.materials, textures);
        surfaces.objects.push_back({part.name, material});
        instances.push_back({part.mesh, std::move(part.world_from_object)});
        if (scene.next) scene.next->world_from_surface.push_back(std::move(part.next));
    }
    set_textures(surfaces, std::move(textures));
    if (!cache.instances || !is_same(cache.instances->instances(), instances)) {
        cache.instances = std::make_shared<const InstanceBvh>(std::move(instances));
        ++stats.instance_trees_built;
    }
    surfaces.bvh = cache.instances;
    scene.surfaces = std::make_shared<const Surfaces>(std::move(surfaces));
    add_surface_lights(scene);
}

}  // namespace mote
