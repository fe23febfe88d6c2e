#include "runs/modes.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "scene/object_parts.h"
#include "surfaces/gltf/gltf_outline.h"

namespace mote {

namespace {

constexpr ModeInfo table[] = {
    {BenchMode::Still, "still", "one frame alone, of many samples"},
    {BenchMode::Static, "static", "one frame after warm-up frames, nothing moves"},
    {BenchMode::Accumulated, "accumulated",
     "the mean of several frames after warm-up frames, nothing moves"},
    {BenchMode::Camera, "camera", "one frame after warm-up frames, only the camera moves"},
    {BenchMode::Moving, "moving", "one frame of the animation, after the frames before it"},
};

BenchMode find_mode(const std::string& name)
{
    std::vector<std::string> known;
    for (const ModeInfo& info : table) {
        if (name == info.name) return info.mode;
        known.emplace_back(info.name);
    }
    throw Error(ExitCode::Usage, fmt::format("no mode \"{}\"{}; the modes are {}", printable(name),
                                             did_you_mean(name, known), fmt::join(known, ", ")));
}

/// Whether a sequence of grids or meshes has more than one file.
bool is_sequence(const std::optional<SequenceParams>& file)
{
    return file && file->pattern.find_first_of("#%$") != std::string::npos;
}

/// Whether keyframes of a glTF file may move what it shows.
bool is_moved_by_file(const std::string& base_dir, const std::string& file)
{
    if (!is_gltf(file)) return false;
    return has_gltf_animations((std::filesystem::path(base_dir) / file).string());
}

/// Turns the camera around the point it is focused on, about its own upright axis.
void orbit(Camera& camera, double degrees)
{
    std::vector<Trs>& keys = camera.world_from_camera.keys;
    const Trs first = keys.front();
    const Vec3d up = first.rotate * Vec3d(0.0, 1.0, 0.0);
    const Vec3d pivot =
        first.translate - double{camera.focus_distance} * (first.rotate * Vec3d(0.0, 0.0, 1.0));
    const glm::dquat turn = glm::angleAxis(glm::radians(degrees), up);
    for (Trs& key : keys) {
        key.translate = pivot + turn * (key.translate - pivot);
        key.rotate = glm::normalize(turn * key.rotate);
    }
}

}  // namespace

int frames_rendered(const FramePlan& plan, bool keeps_history)
{
    return keeps_history ? static_cast<int>(plan.frames.size()) : plan.compared;
}

std::span<const ModeInfo> mode_table()
{
    return table;
}

const char* mode_name(BenchMode mode)
{
    return table[static_cast<size_t>(mode)].name;
}

bool is_animated(const SceneDescription& scene)
{
    if (scene.camera.keys.size() > 1 || !scene.particles.empty()) return true;
    if (is_moved_by_file(scene.base_dir, scene.camera.file.path)) return true;
    const bool objects_move = std::any_of(
        scene.objects.begin(), scene.objects.end(), [&](const ObjectDescription& object) {
            return object.transform.size() > 1 || is_sequence(object.file) ||
                   is_moved_by_file(scene.base_dir, object.file.pattern);
        });
    const bool volumes_move =
        std::any_of(scene.volumes.begin(), scene.volumes.end(), [](const VolumeDescription& v) {
            return v.transform.size() > 1 || is_sequence(v.file) ||
                   (v.procedural && v.procedural->evolve != 0.0f);
        });
    const bool lights_change =
        std::any_of(scene.lights.begin(), scene.lights.end(), [](const LightDescription& light) {
            return light.transform.size() > 1 || light.keys.size() > 1;
        });
    return objects_move || volumes_move || lights_change;
}

std::vector<BenchMode> choose_modes(const std::string& list, const SceneDescription& scene)
{
    std::vector<BenchMode> modes;
    for (const std::string& name : split_list(list)) {
        const BenchMode mode = find_mode(name);
        if (std::find(modes.begin(), modes.end(), mode) == modes.end()) modes.push_back(mode);
    }
    if (!modes.empty()) return modes;
    if (is_animated(scene)) return {BenchMode::Moving};
    return {BenchMode::Still, BenchMode::Static};
}

FramePlan plan_frames(const SceneDescription& scene, BenchMode mode, int frame,
                      const FrameCounts& counts, SceneCache& cache)
{
    FramePlan plan;
    plan.sample_factor = mode == BenchMode::Still ? counts.still : 1;
    plan.compared = mode == BenchMode::Accumulated ? counts.still : 1;
    const int before = mode == BenchMode::Still ? 0 : counts.warm_up + plan.compared - 1;
    PrepareNeeds needs;
    needs.velocity = mode == BenchMode::Moving;
    needs.velocity_may_be_missing = true;
    PrepareStats ignored;
    const auto prepare = [&](int number) {
        return prepare_frame(scene, number, needs, cache, ignored);
    };
    const Scene last = prepare(frame);
    for (int number = frame - before; number < frame; ++number) {
        plan.frames.push_back(mode == BenchMode::Moving ? prepare(number) : last);
        plan.frames.back().frame = number;
        if (mode == BenchMode::Camera) {
            orbit(plan.frames.back().camera, camera_step * (number - frame));
        }
    }
    plan.frames.push_back(last);
    return plan;
}

}  // namespace mote
