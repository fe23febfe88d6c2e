#pragma once

#include "scene/surface_lights.h"
#include "surfaces/meshes.h"

namespace mote::test {

/// One thing of a scene.
struct Thing {
    Mesh mesh;
    Material material;
    Trs trs{};
    MaterialTextures textures{};
};

inline Material diffuse(Spectrum color, Spectrum emission = Spectrum(0.0f))
{
    Material material;
    material.base_color = color;
    material.emission = emission;
    return material;
}

/// Puts surfaces into a scene; call it after its lamps are set.
inline void add_surfaces(Scene& scene, std::vector<Thing> things)
{
    Surfaces surfaces;
    std::vector<MaterialTextures> textures;
    std::vector<MeshInstance> instances;
    for (Thing& thing : things) {
        surfaces.objects.push_back({"thing", static_cast<int>(surfaces.materials.size())});
        surfaces.materials.push_back(thing.material);
        textures.push_back(thing.textures);
        MeshInstance instance{std::make_shared<const MeshBvh>(std::move(thing.mesh)), {}};
        instance.world_from_object.keys = {thing.trs};
        instances.push_back(std::move(instance));
    }
    set_textures(surfaces, std::move(textures));
    surfaces.bvh = std::make_shared<const InstanceBvh>(std::move(instances));
    scene.surfaces = std::make_shared<const Surfaces>(std::move(surfaces));
    add_surface_lights(scene);
}

}  // namespace mote::test
