#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "app/commands.h"
#include "app/frame_files.h"
#include "app/scene_options.h"
#include "app/signals.h"
#include "app/text_file.h"
#include "app/verify_options.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/text.h"
#include "runs/methods.h"
#include "scene/scene_io.h"
#include "study/verify_report.h"

namespace mote {

namespace {

/// Enough for tiles to tell places apart, few enough for many runs.
constexpr double usual_pixels = 96.0 * 54.0;

bool sets_size(const std::vector<std::string>& overrides)
{
    return std::any_of(overrides.begin(), overrides.end(), [](const std::string& text) {
        return text.rfind("render.width", 0) == 0 || text.rfind("render.height", 0) == 0;
    });
}

/// Loads the scene, smaller unless a size was asked for; says so in a note.
SceneDescription load_verify_scene(const VerifyOptions& options, std::vector<std::string>& notes)
{
    std::vector<std::string> overrides = options.overrides;
    overrides.insert(overrides.end(), options.resolution.begin(), options.resolution.end());
    SceneDescription scene = load_scene(options.scene, overrides);
    const int width = scene.render.width;
    const int height = scene.render.height;
    const double scale = std::sqrt(usual_pixels / (double(width) * height));
    if (options.full_size || sets_size(overrides) || scale >= 1.0) return scene;
    const auto lowered = [&](int size) {
        return std::max(1, static_cast<int>(std::lround(scale * size)));
    };
    overrides.push_back(fmt::format("render.width={}", lowered(width)));
    overrides.push_back(fmt::format("render.height={}", lowered(height)));
    scene = load_scene(options.scene, overrides);
    notes.push_back(fmt::format("resolution lowered from {} x {} to {} x {} (--full-size keeps it)",
                                width, height, scene.render.width, scene.render.height));
    return scene;
}

[[noreturn]] void fail(const VerifyResult& result)
{
    const bool is_biased = result.study.verdict() == Verdict::BiasFound;
    throw Error(is_biased ? ExitCode::BiasFound : ExitCode::NotEnoughRuns,
                fmt::format("{}: {}: {}{}", printable(result.path, 1000),
                            verdict_name(result.study.verdict()), result.study.last().reason,
                            is_biased ? "" : "; give it more --time"));
}

}  // namespace

void run_verify(const VerifyOptions& options)
{
    const StopSignals signals;
    const VerifyParams params = verify_params(options);
    // Wrong names come to light before anything is rendered.
    if (!params.method.empty()) (void)find_method(params.method);
    if (!params.reference.empty()) (void)find_method(params.reference);
    std::vector<std::string> notes;
    const SceneDescription scene = load_verify_scene(options, notes);
    if (!options.json.empty()) require_writable_folder(options.json);
    if (!options.html.empty()) require_writable_folder(options.html);

    const VerifyHooks hooks{stop_requested, [](const std::string& line) { spdlog::info(line); }};
    VerifyResult result;
    run_with_threads(chosen_threads(options.threads),
                     [&] { result = verify_scene(scene, params, hooks); });
    const VerifyReport report{result, notes, scene.output.view, MOTE_VERSION};
    fmt::print("{}", verify_text(report));
    std::fflush(stdout);
    if (!options.json.empty()) write_text_file(options.json, verify_json(report));
    if (!options.html.empty()) write_text_file(options.html, verify_html(report));
    if (result.study.verdict() != Verdict::NoBias) fail(result);
}

}  // namespace mote
