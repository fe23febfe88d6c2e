#pragma once

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "restir/cache_stats.h"
#include "restir/reuse_modes.h"
#include "restir/reuse_runs.h"

namespace mote::test {

/// A scene's frames, of which the last is compared.
struct SceneCase {
    std::string name;
    std::vector<Scene> (*frames)(int count);
    bool control_variate = true;  ///< false: lights at infinity are reused too
};

/// For the names of tests.
inline void PrintTo(const SceneCase& scene, std::ostream* out)
{
    *out << scene.name;
}
inline std::string scene_case_name(const testing::TestParamInfo<SceneCase>& info)
{
    std::string name = info.param.name;
    std::replace_if(
        name.begin(), name.end(),
        [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
    return name;
}

/// How sharply to look.
struct JudgeEffort {
    int frames = 4;
    int runs = 40;
    int reference_runs = 32;
    int reference_samples = 100;
    int samples = 1;
    double alpha = 1e-5;  ///< false-alarm rate of one comparison
};

/// What every way to reuse is held against.
struct JudgedScene {
    std::string name;
    std::vector<Scene> frames;
    FrameCaches caches;
    TileStats reference{tile_edge};
};
[[nodiscard]] inline JudgedScene judged_scene(const SceneCase& scene, const JudgeEffort& effort)
{
    JudgedScene out{scene.name, scene.frames(effort.frames), {}, TileStats(tile_edge)};
    out.caches = make_frame_caches(out.frames);
    out.reference = path_traced_runs(out.frames.back(), effort.reference_samples,
                                     {effort.reference_runs, 1'000'000});
    return out;
}

/// How one way to reuse compares: observations are whole images and tiles of independent runs;
/// Welch's test of each against the path tracer, and Student's of what reuse adds to the same
/// candidates without it, both corrected for their number.
struct ReuseVerdict {
    double p = 1.0;        ///< against the path tracer
    double p_added = 1.0;  ///< that reuse adds nothing
    Bias bias;
    Bias added;
    int64_t non_finite = 0;
    std::string row;  ///< for people
};
[[nodiscard]] inline ReuseVerdict judge_reuse(const JudgedScene& scene, const ReuseCase& each,
                                              const JudgeEffort& effort)
{
    const double start = process_cpu_seconds();
    const ReuseRuns tested =
        play_runs(scene.frames, scene.caches, each.params, {effort.runs, 1, effort.samples});
    const RunComparison comparison = compare_runs(tested.images, scene.reference);
    const AddedBias added = test_added(tested.added, scene.reference);
    ReuseVerdict out{comparison.p,          added.p, bias_of(comparison), added.whole_image,
                     comparison.non_finite, {}};
    out.row = fmt::format(
        "{:14} {:22} {:+6.2f} +- {:4.2f} %  z {:+5.2f}  p {:8.2g}   added {:+6.2f} +- {:4.2f} %  "
        "z {:+5.2f}  p {:8.2g}   {:.1f} s",
        scene.name, each.name, 100.0 * out.bias.relative, 100.0 * out.bias.standard_error,
        out.bias.z, out.p, 100.0 * out.added.relative, 100.0 * out.added.standard_error,
        out.added.z, out.p_added, process_cpu_seconds() - start);
    if (std::getenv("MOTE_REPORT")) std::printf("%s\n", out.row.c_str());
    return out;
}

/// Plays all of `cases` and expects no bias of any.
inline void expect_unbiased(const SceneCase& scene, const std::vector<ReuseCase>& cases,
                            const JudgeEffort& effort)
{
    const JudgedScene judged = judged_scene(scene, effort);
    for (ReuseCase each : cases) {
        each.params.control_variate &= scene.control_variate;
        const ReuseVerdict verdict = judge_reuse(judged, each, effort);
        EXPECT_GT(verdict.p, effort.alpha) << verdict.row;
        EXPECT_GT(verdict.p_added, effort.alpha) << verdict.row;
        EXPECT_EQ(verdict.non_finite, 0) << verdict.row;
    }
}

}  // namespace mote::test
