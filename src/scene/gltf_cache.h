#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "surfaces/gltf/gltf_scene.h"
#include "surfaces/mesh_bvh.h"

namespace mote {

/// A glTF file ready to be placed.
struct LoadedGltf {
    std::string path;
    std::string version;  ///< of it and of the files that it names
    GltfScene scene;
    std::vector<std::shared_ptr<const MeshBvh>> meshes;  ///< of scene.parts; taken when needed
    std::map<std::string, std::shared_ptr<const MeshBvh>> sheared;  ///< by part and matrix
};

/// glTF files kept between frames.
class GltfCache {
  public:
    /// Throws Error(Input) naming the file.
    [[nodiscard]] LoadedGltf& get(const std::string& path);

    /// Drops the files that nobody asked for since the last call.
    void drop_unused();

  private:
    std::map<std::string, std::vector<std::string>> files_;  ///< by version of the file alone
    std::map<std::string, std::unique_ptr<LoadedGltf>> held_;
    std::set<std::string> wanted_;
};

}  // namespace mote
