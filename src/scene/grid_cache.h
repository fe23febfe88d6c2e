#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>

#include "scene/environment.h"
#include "scene/gltf_cache.h"
#include "scene/prepare.h"
#include "scene/texture_cache.h"
#include "surfaces/instance_bvh.h"
#include "volumes/bricks.h"
#include "volumes/grid_source.h"

namespace mote {

/// A grid ready to render: scalar or vector.
struct CachedGrid {
    std::shared_ptr<const BrickGrid> scalar;
    std::shared_ptr<const ColorGrid> vector;
};

/// Grids, environment maps, meshes, textures and glTF files under a text that says everything they
/// depend on: file, size and modification time; particle source version and raster settings;
/// parameters and time.
struct SceneCache::Impl {
    std::map<std::string, CachedGrid> grids;
    std::map<std::string, std::shared_ptr<const EnvironmentMap>> environments;
    std::map<std::string, std::shared_ptr<const MeshBvh>> meshes;
    GltfCache gltfs;
    TextureCache textures;
    std::shared_ptr<const InstanceBvh> instances;  ///< of the latest frame with surfaces

    /// Drops what is not wanted, before anything new is built: a sequence never holds two frames.
    void keep_only(const std::set<std::string>& wanted)
    {
        for (auto it = grids.begin(); it != grids.end();) {
            it = wanted.count(it->first) ? std::next(it) : grids.erase(it);
        }
    }
};

/// Path, size and modification time. Throws Error(Input) naming the file if it is missing.
[[nodiscard]] std::string file_version(const std::string& path);

}  // namespace mote
