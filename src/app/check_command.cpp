#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "app/check_inputs.h"
#include "app/commands.h"
#include "app/frame_files.h"
#include "app/frame_range.h"
#include "app/image_metadata.h"
#include "app/scene_options.h"
#include "core/error.h"
#include "scene/scene_io.h"

namespace mote {

void run_check(const CheckOptions& options)
{
    const SceneDescription scene = load_scene(options.scene, options.overrides);
    const std::vector<int> frames = chosen_frames(options.frames, scene);
    (void)frame_files(frames, scene.output.path, scene.output.preview);
    const InputReport inputs = check_inputs(scene, frames);
    if (!inputs.problems.empty()) {
        throw Error(ExitCode::Input, fmt::format("{}", fmt::join(inputs.problems, "\n")));
    }
    if (inputs.opened_files < inputs.sequence_files) {
        spdlog::warn(
            "time was up after the headers of {} of {} files; the others are there, unopened: "
            "--frames checks a part",
            inputs.opened_files, inputs.sequence_files);
    }
    fmt::print(
        "{}: no mistakes found; frames {}, {} volumes, {} particle systems, {} lights, hash "
        "{}\n",
        scene.path, format_frames(frames), scene.volumes.size(), scene.particles.size(),
        scene.lights.size(), scene_hash_text(scene));
}

}  // namespace mote
