#include "scene/gltf_cache.h"

#include "scene/grid_cache.h"

namespace mote {

LoadedGltf& GltfCache::get(const std::string& path)
{
    std::vector<std::string>& files = files_[file_version(path)];
    if (files.empty()) files = gltf_files(path);
    std::string version;
    for (const std::string& file : files) version += file_version(file) + "; ";
    wanted_.insert(version);
    std::unique_ptr<LoadedGltf>& held = held_[version];
    if (!held) {
        auto loaded = std::make_unique<LoadedGltf>();
        loaded->path = path;
        loaded->version = version;
        loaded->scene = load_gltf(path);
        loaded->meshes.resize(loaded->scene.parts.size());
        held = std::move(loaded);
    }
    return *held;
}

void GltfCache::drop_unused()
{
    for (auto it = held_.begin(); it != held_.end();) {
        it = wanted_.count(it->first) ? std::next(it) : held_.erase(it);
    }
    if (held_.empty()) files_.clear();
    wanted_.clear();
}

}  // namespace mote
