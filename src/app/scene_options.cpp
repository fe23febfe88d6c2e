#include "app/scene_options.h"

#include <fmt/format.h>

#include "app/frame_range.h"
#include "core/parallel.h"
#include "scene/scene_io.h"

namespace mote {

namespace {

/// --aovs as an override, so that a wrong name is refused like one in the file.
std::string aov_override(const std::string& list)
{
    std::string words;
    constexpr const char* separators = ", ";
    for (size_t begin = list.find_first_not_of(separators); begin != std::string::npos;) {
        const size_t end = std::min(list.find_first_of(separators, begin), list.size());
        const std::string word = list.substr(begin, end - begin);
        if (word.find_first_of("\"\\") != std::string::npos) {
            throw Error(ExitCode::Usage, "--aovs: layer names hold no quotes");
        }
        if (word != "none") words += fmt::format("{}\"{}\"", words.empty() ? "" : ",", word);
        begin = list.find_first_not_of(separators, end);
    }
    return fmt::format("output.aovs=[{}]", words);
}

}  // namespace

SceneDescription load_render_scene(const RenderOptions& options)
{
    std::vector<std::string> overrides = options.overrides;
    if (options.aovs) overrides.push_back(aov_override(*options.aovs));
    SceneDescription scene = load_scene(options.scene, overrides);
    if (!options.output.empty()) scene.output.path = options.output;
    if (!options.preview.empty()) scene.output.preview = options.preview;
    return scene;
}

std::vector<int> chosen_frames(const std::string& list, const SceneDescription& scene)
{
    if (!list.empty()) return parse_frames(list);
    return parse_frames(fmt::format("{}-{}", scene.first_frame, scene.last_frame));
}

int chosen_threads(int asked)
{
    return asked > 0 ? asked : available_threads();
}

}  // namespace mote
