#pragma once

#include "surfaces/gltf/gltf_accessor.h"
#include "surfaces/gltf/gltf_scene.h"

namespace mote {

/// Which texture coordinates a material's pictures use. glTF lets each picture have its own; here
/// those of the first one serve for all.
struct GltfUvChoice {
    int set = 0;
    glm::mat3 from_file{1.0f};  ///< KHR_texture_transform, of coordinates with v downwards
};

/// Images, materials and `uvs`, one entry per material. See gltf_materials.cpp.
void convert_materials(const GltfSource& source, GltfScene& out, std::vector<GltfUvChoice>& uvs);

/// The primitives of a mesh that can be drawn, appended to out.parts; their numbers. Warns of what
/// is left out. Throws Error(Input).
[[nodiscard]] std::vector<int> convert_mesh(const GltfSource& source, int mesh,
                                            const std::vector<GltfUvChoice>& uvs, GltfScene& out);

/// Nodes of the default scene, with meshes and cameras. Throws Error(Input) for cycles.
void convert_nodes(const GltfSource& source, const std::vector<GltfUvChoice>& uvs, GltfScene& out);

/// What of a file is not shown, in words: vertex colours, samplers, extensions.
[[nodiscard]] std::vector<std::string> left_out(const tinygltf::Model& model);

/// Warns of it, once.
void warn_of_left_out(const GltfSource& source);

/// Keyframes of every animation; of two that move the same property the first one counts.
/// `node_of` has the number in `out` of each of the file's nodes, -1: not in the scene.
void convert_animations(const GltfSource& source, const std::vector<int>& node_of, GltfScene& out);

}  // namespace mote
