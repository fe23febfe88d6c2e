#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/transform.h"
#include "surfaces/material.h"
#include "surfaces/mesh.h"
#include "surfaces/texture.h"

namespace mote {

/// A picture: a file, or one inside of the glTF file.
struct GltfImage {
    std::string path;            ///< of the file; else what messages call it
    std::vector<uint8_t> bytes;  ///< of pictures inside
};

/// Use of a picture.
struct GltfPicture {
    int image = -1;  ///< into GltfScene::images; -1: none
    TextureSampler sampler;
};

/// A material and its pictures. See MaterialTextures for what they do.
struct GltfMaterial {
    std::string name;
    Material look;
    GltfPicture color, metallic_roughness, normal, emission;
    float normal_strength = 1.0f;
    float opacity = 1.0f;
    float alpha_cutoff = 0.0f;

    [[nodiscard]] bool has_pictures() const
    {
        return std::max({color.image, metallic_roughness.image, normal.image, emission.image}) >= 0;
    }
};

/// Triangles of one material, finished. Texture coordinates have v upwards.
struct GltfPart {
    Mesh mesh;
    int material = 0;  ///< into GltfScene::materials
};

enum class GltfInterpolation { Linear, Step, Cubic };

/// Keyframes of one property of a node.
struct GltfTrack {
    GltfInterpolation interpolation = GltfInterpolation::Linear;
    std::vector<float> times;       ///< ascending [s]
    std::vector<glm::vec4> values;  ///< one per time; cubic: in-tangent, value, out-tangent
};

/// A place in the hierarchy. Parents come before their children.
struct GltfNode {
    std::string name;
    int parent = -1;
    Trs trs;                      ///< parent from node
    std::optional<Mat4d> matrix;  ///< in place of trs; never animated
    std::optional<GltfTrack> translation, rotation, scale;
    std::vector<int> parts;  ///< into GltfScene::parts
    int camera = -1;         ///< into GltfScene::cameras
};

struct GltfCamera {
    std::string name;
    double fov_y = 45.0;  ///< vertical field of view [degrees]
};

/// What mote shows of a glTF 2.0 file: meshes in their places, materials, cameras, animated nodes.
/// Left out, with a warning where it would be missed: skins, morph targets, lights, lines, points.
struct GltfScene {
    std::vector<GltfImage> images;
    std::vector<GltfMaterial> materials;  ///< the last one is glTF's default material
    std::vector<GltfPart> parts;
    size_t corner_count = 0;      ///< of all triangles of all parts
    std::vector<GltfNode> nodes;  ///< of the default scene
    std::vector<GltfCamera> cameras;
};

/// A .gltf or .glb file. tinygltf reads it first in a child process of limited memory and time;
/// then every index, range and size is checked. Files that it names must lie in its folder or
/// below. Throws Error(Input) or Error(Memory) naming the file. Cost: about twice tinygltf's.
[[nodiscard]] GltfScene load_gltf(const std::string& path);

/// The file itself and all that it names and that exist: what its content depends on. Throws as
/// load_gltf does, but reads no more than the JSON.
[[nodiscard]] std::vector<std::string> gltf_files(const std::string& path);

/// Where a node is at a time [s]; before the first and after the last key it stands still.
[[nodiscard]] Mat4d world_from_node(const GltfScene& scene, int node, double seconds);

/// Whether the node or one above it has keyframes.
[[nodiscard]] bool is_animated(const GltfScene& scene, int node);

}  // namespace mote
