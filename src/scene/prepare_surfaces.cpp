#include "scene/prepare_surfaces.h"

#include <algorithm>

#include <fmt/format.h>

#include "particles/sequence.h"
#include "scene/surface_lights.h"
#include "surfaces/load_mesh.h"

namespace mote {
namespace {

/// An object shown at the frame.
struct Shown {
    const ObjectDescription* object = nullptr;
    size_t index = 0;
    std::string path;
    std::string version;  ///< of its mesh
};

std::vector<Shown> shown_objects(const SceneDescription& description, int frame)
{
    std::vector<Shown> shown;
    for (size_t i = 0; i < description.objects.size(); ++i) {
        const ObjectDescription& object = description.objects[i];
        const auto path = resolve_sequence(object.file, frame, description.base_dir);
        if (path) shown.push_back({&object, i, *path, file_version(*path)});
    }
    return shown;
}

/// Drops meshes that the frame does not show before it loads new ones.
void load_meshes(const std::vector<Shown>& shown, SceneCache::Impl& cache, PrepareStats& stats)
{
    std::set<std::string> wanted;
    for (const Shown& s : shown) wanted.insert(s.version);
    for (auto it = cache.meshes.begin(); it != cache.meshes.end();) {
        it = wanted.count(it->first) ? std::next(it) : cache.meshes.erase(it);
    }
    for (const Shown& s : shown) {
        if (cache.meshes.count(s.version)) continue;
        cache.meshes[s.version] = std::make_shared<const MeshBvh>(load_mesh(s.path));
        ++stats.meshes_built;
    }
    stats.meshes_reused += static_cast<int>(wanted.size()) - stats.meshes_built;
    for (const auto& [version, mesh] : cache.meshes) stats.mesh_bytes += mesh->memory_bytes();
}

Material make_material(const MaterialDescription& from)
{
    Material material = from.look;
    material.emission = from.emission * from.emission_color;
    return material;
}

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

/// Emissive objects stand still in the middle of the shutter, as lamps do.
MovingTransform transform_of(const ObjectDescription& object, const Material& material, double open,
                             double close)
{
    if (!material.is_emissive()) return over_shutter(object.transform, open, close);
    return MovingTransform{{evaluate(object.transform, 0.5 * (open + close))}};
}

bool is_same(const std::vector<MeshInstance>& a, const std::vector<MeshInstance>& b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const MeshInstance& p, const MeshInstance& q) {
                          return p.mesh == q.mesh && p.world_from_object == q.world_from_object;
                      });
}

}  // namespace

void prepare_surfaces(const SceneDescription& description, const ShutterTimes& times,
                      SceneCache::Impl& cache, PrepareStats& stats, Scene& scene)
{
    const std::vector<Shown> shown = shown_objects(description, times.frame);
    if (shown.empty()) {
        cache.meshes.clear();
        cache.instances.reset();
        return;
    }
    load_meshes(shown, cache, stats);
    Surfaces surfaces;
    std::vector<MeshInstance> instances;
    for (const Shown& s : shown) {
        const std::string& name = s.object->name;
        const Material material = make_material(material_of(description, *s.object));
        surfaces.objects.push_back({name.empty() ? fmt::format("object {}", s.index) : name,
                                    static_cast<int>(surfaces.materials.size())});
        surfaces.materials.push_back(material);
        instances.push_back({cache.meshes.at(s.version),
                             transform_of(*s.object, material, times.open, times.close)});
        if (scene.next) {
            scene.next->world_from_surface.push_back(
                transform_of(*s.object, material, times.open + 1.0, times.close + 1.0));
        }
    }
    if (!cache.instances || !is_same(cache.instances->instances(), instances)) {
        cache.instances = std::make_shared<const InstanceBvh>(std::move(instances));
        ++stats.instance_trees_built;
    }
    surfaces.bvh = cache.instances;
    scene.surfaces = std::make_shared<const Surfaces>(std::move(surfaces));
    add_surface_lights(scene);
}

}  // namespace mote
