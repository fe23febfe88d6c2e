#pragma once

#include <string>
#include <vector>

#include "scene/grid_cache.h"
#include "scene/prepare_surfaces.h"

namespace mote {

/// A material with its pictures.
struct SurfaceLook {
    Material material;
    MaterialTextures textures;
};

/// A mesh of one material in its place: what the objects of a scene consist of.
struct ObjectPart {
    std::string name;
    std::shared_ptr<const MeshBvh> mesh;
    SurfaceLook look;
    MovingTransform world_from_object;
    MovingTransform next;  ///< one frame later
};

/// An object shown at a frame.
struct ShownObject {
    const ObjectDescription* object = nullptr;
    std::string name;  ///< its own, or "object 2"
    std::string path;
    std::string version;  ///< of its file
};

/// What parts are made from.
struct PartContext {
    const SceneDescription& description;
    const ShutterTimes& times;
    SceneCache::Impl& cache;
    PrepareStats& stats;
};

/// Appends the one part of an object that is a mesh file. Throws Error(Input) naming the file.
void add_mesh_part(const PartContext& context, const ShownObject& shown,
                   std::vector<ObjectPart>& parts);

/// Appends the meshes of a glTF file, each in the place of its node at the frame's time: the
/// file's second 0 is frame 0. Throws Error(Input) naming the file.
void add_gltf_parts(const PartContext& context, const ShownObject& shown,
                    std::vector<ObjectPart>& parts);

/// Whether a path is a glTF file's, by its ending.
[[nodiscard]] bool is_gltf(const std::string& path);

/// What the scene says that an object is made of. Throws Error(Input) naming the picture's file.
[[nodiscard]] SurfaceLook make_look(const PartContext& context, const ObjectDescription& object);

/// The pictures of a scene's material. Throws Error(Input) naming the file.
[[nodiscard]] MaterialTextures make_textures(const PartContext& context,
                                             const MaterialFiles& files);

/// Throws Error(Input) if a material has pictures but the mesh no coordinates for them.
void require_uvs(const MeshBvh& mesh, const MaterialTextures& textures, const std::string& file);

/// Keyframes over the shutter. Emissive objects stand still in its middle, as lamps do.
[[nodiscard]] MovingTransform placement(const std::vector<TransformKey>& keys, bool is_emissive,
                                        double open, double close);

}  // namespace mote
