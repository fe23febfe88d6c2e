#include "scene/inputs.h"

#include <filesystem>
#include <set>
#include <variant>

#include <fmt/format.h>

#include "particles/sequence.h"
#include "particles/source.h"
#include "scene/grid_cache.h"
#include "scene/hash.h"

namespace mote {
namespace {

/// Sorted, so that the order of entries in the scene does not count.
std::set<std::string> input_files(const SceneDescription& description, int frame)
{
    std::set<std::string> shown_particles;
    std::set<std::string> files;
    const auto add_sequence = [&](const SequenceParams& sequence) {
        if (const auto path = resolve_sequence(sequence, frame, description.base_dir)) {
            files.insert(*path);
        }
    };
    for (const VolumeDescription& volume : description.volumes) {
        if (volume.file) add_sequence(*volume.file);
        shown_particles.insert(volume.particles);
    }
    for (const ParticlesDescription& particles : description.particles) {
        const auto* cache = std::get_if<CacheParams>(&particles.source);
        if (cache && shown_particles.count(particles.name) > 0) add_sequence(cache->sequence);
    }
    for (const ObjectDescription& object : description.objects) add_sequence(object.file);
    for (const LightDescription& light : description.lights) {
        if (light.image.empty()) continue;
        files.insert((std::filesystem::path(description.base_dir) / light.image).string());
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
