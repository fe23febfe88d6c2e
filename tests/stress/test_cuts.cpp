// Sequences that give history no rest: empty frames, a cut at every frame, densities that jump.
#include <gtest/gtest.h>

#include "restir/reuse_scenes.h"
#include "stress/play.h"
#include "stress/stress_scenes.h"

namespace mote {
namespace {

Scene full()
{
    Scene scene = test::lit_by_all(test::clumps(5.0f));
    scene.camera = test::small_camera({0.5f, 0.4f, 3.2f});
    return scene;
}

std::vector<test::Way> ways_with_history()
{
    std::vector<test::Way> ways;
    for (const test::Way& way : test::all_ways(1, 1)) {
        if (uses_history(way.render)) ways.push_back(way);
    }
    RestirParams automatic;
    ways.push_back(test::restir_way("auto", automatic, 1, 1));
    return ways;
}

/// Numbers the frames.
std::vector<Scene> numbered(std::vector<Scene> frames)
{
    for (size_t i = 0; i < frames.size(); ++i) frames[i].frame = static_cast<int>(i) + 1;
    return frames;
}

/// Plays the frames in every way; the last frame must be the path tracer's. The false-alarm rate
/// of one way is 1e-5.
void expect_right_end(const std::vector<Scene>& frames, const std::string& what, int runs = 12)
{
    const TileStats reference =
        test::last_frames({&frames.back(), 1}, test::path_way(1, 150), runs, 100'000, what);
    for (const test::Way& way : ways_with_history()) {
        const RunComparison comparison =
            compare_runs(test::last_frames(frames, way, runs, 1, what), reference);
        test::expect_same(comparison, way.name + ", " + what);
    }
}

TEST(StressCutsStat, EmptyFramesBetweenFullOnes)
{
    Scene empty = full();
    empty.media.volumes.clear();
    Scene clear = full();  // a medium of density 0
    clear.media.volumes[0].density_scale = 0.0f;
    finalize(clear.media.volumes[0]);
    Scene dark = full();
    dark.lights.clear();
    dark.environment.reset();
    expect_right_end(numbered({full(), empty, full(), clear, full(), dark, empty, full()}),
                     "empty frames");
}

/// Enough to see what HistoryKeptAcrossACutIsFound must find.
constexpr int cut_runs = 24;

/// The camera jumps around the smoke.
std::vector<Scene> cuts()
{
    std::vector<Scene> frames;
    for (int i = 0; i < 6; ++i) {
        Scene scene = full();
        const float angle = 2.1f * static_cast<float>(i);
        scene.camera = test::small_camera(3.0f * Vec3(std::sin(angle), 0.2f, std::cos(angle)));
        frames.push_back(scene);
    }
    return numbered(frames);
}

TEST(StressCutsStat, ACutEveryFrame)
{
    expect_right_end(cuts(), "a cut every frame", cut_runs);
}

/// The last frame by a renderer that does not notice cuts: it takes the samples of the frame before
/// for samples of this one.
LayeredImage play_over_cuts(const std::vector<Scene>& frames, test::Way way, uint32_t seed)
{
    OutputDescription output;
    output.aovs = test::part_names;
    output.color_type = PixelType::Float;
    way.render.width = frames[0].camera.width;
    way.render.height = frames[0].camera.height;
    way.render.seed = seed;
    LayeredImage image;
    FrameHistory history;
    for (const Scene& scene : frames) {
        FrameStats stats;
        if (!history.impl().before.empty()) {
            FrameHistory here;
            (void)render_frame(scene, way.render, output, here, nullptr, stats);
            here.impl().before.reservoirs = history.impl().before.reservoirs;
            history.impl() = std::move(here.impl());
        }
        image = render_frame(scene, way.render, output, history, nullptr, stats);
    }
    return image;
}

/// What ACutEveryFrame must reject, at the same effort, in the ways where history weighs most: half
/// of the light is missing.
TEST(StressCutsStat, HistoryKeptAcrossACutIsFound)
{
    const std::vector<Scene> frames = cuts();
    const TileStats reference = test::last_frames({&frames.back(), 1}, test::path_way(1, 150),
                                                  cut_runs, 100'000, "reference");
    for (const test::Way& way : ways_with_history()) {
        if (way.name != "both, world" && way.name != "textbook") continue;
        const TileStats kept = test::collect(
            cut_runs, 1, [&](uint32_t seed) { return play_over_cuts(frames, way, seed); });
        const RunComparison comparison = compare_runs(kept, reference);
        EXPECT_LT(comparison.p, test::alarm) << test::summary(way.name, comparison);
    }
}

TEST(StressCutsStat, DensitiesThatJumpAMillionfold)
{
    const auto with = [](float factor) {
        Scene scene = full();
        scene.media.volumes[0].density_scale *= factor;
        finalize(scene.media.volumes[0]);
        return scene;
    };
    expect_right_end(numbered({with(1e6f), full()}), "from opaque");
    expect_right_end(numbered({full(), with(1e6f), full()}), "to opaque and back");
    expect_right_end(numbered({full(), with(1e-6f), full()}), "to nearly nothing and back");
}

TEST(StressCuts, JumpsAtBothEndsStaySound)
{
    const auto with = [](float density, float power) {
        Scene scene = test::lit_by_all(test::clumps(density));
        scene.lights.push_back(PointLight{{0.1f, 0.1f, 0.1f}, Spectrum(power)});
        return scene;
    };
    const std::vector<Scene> frames =
        numbered({with(1e-8f, 1e20f), with(1e8f, 1e-20f), with(1e-8f, 1e-20f), with(1e8f, 1e20f),
                  with(1.0f, 1.0f)});
    for (const test::Way& way : ways_with_history()) test::play(frames, way, "jumps");
}

TEST(StressCuts, FilmsThatChangeTheirSize)
{
    std::vector<Scene> frames;
    for (const auto& [width, height] :
         std::initializer_list<std::pair<int, int>>{{16, 9}, {1, 1}, {33, 2}, {1, 40}, {16, 9}}) {
        Scene scene = full();
        scene.camera.width = width;
        scene.camera.height = height;
        frames.push_back(scene);
    }
    for (const test::Way& way : ways_with_history()) test::play(numbered(frames), way, "sizes");
}

}  // namespace
}  // namespace mote
