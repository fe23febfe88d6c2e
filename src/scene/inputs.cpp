#include "scene/inputs.h"

#include <filesystem>
#include <set>
#include <variant>

#include <fmt/format.h>

#include "particles/sequence.h"
#include "particles/source.h"
#include "scene/grid_cache.h"
#include "scene/hash.h"
#include "scene/object_parts.h"

namespace mote {
namespace {

/// A file, and those that it names.
void add_with_named(const std::string& path, std::set<std::string>& files)
{
    if (!is_gltf(path)) {
        files.insert(path);
        return;
    }
    for (const std::string& file : gltf_files(path)) files.insert(file);
}

/// Sorted, so that the order of entries in the scene does not count.
std::set<std::string> input_files(const SceneDescription& description, int frame)
{
    std::set<std::string> shown_particles;
    std::set<std::string> files;
    const auto add_sequence = [&](const SequenceParams& sequence) {
        const auto path = resolve_sequence(sequence, frame, description.base_dir);
        if (path) add_with_named(*path, files);
    };
    for (const VolumeDescription& volume : description.volumes) {
        if (volume.file) add_sequence(*volume.file);
        shown_particles.insert(volume.particles);
    }
    for (const LightDescription& light : description.lights) {
        shown_particles.insert(light.particles);
    }
    for (const ParticlesDescription& particles : description.particles) {
        const auto* cache = std::get_if<CacheParams>(&particles.source);
        if (cache && shown_particles.count(particles.name) > 0) add_sequence(cache->sequence);
    }
    const auto add_file = [&](const std::string& file) {
        if (file.empty()) return;
        files.insert((std::filesystem::path(description.base_dir) / file).string());
    };
    const auto add_pictures = [&](const MaterialDescription& material) {
        for (const std::string* file : picture_files(material.files)) add_file(*file);
    };
    for (const MaterialDescription& material : description.materials) add_pictures(material);
    for (const ObjectDescription& object : description.objects) {
        add_sequence(object.file);
        add_pictures(object.material);
    }
    for (const LightDescription& light : description.lights) add_file(light.image);
    const std::string& camera = description.camera.file.path;
    if (!camera.empty()) {
        add_with_named((std::filesystem::path(description.base_dir) / camera).string(), files);
    }
    return files;
}

}  // namespace

std::string inputs_hash(const SceneDescription& description, int frame)
{
    const std::set<std::string> files = input_files(description, frame);
    if (files.empty()) return "";
    Hasher hasher;
    for (const std::string& file : files) {
        // Absolute: a scene is the same one from whichever folder it is named.
        hasher.add(file_version(std::filesystem::absolute(file).lexically_normal().string()));
    }
    return fmt::format("{:016x}", hasher.value());
}

}  // namespace mote
