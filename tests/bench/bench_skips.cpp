// What a frame saves where something is missing: process CPU time of the ReSTIR estimator on scenes
// with and without each thing, and the counters that show the skip.
//   bench_skips [rounds = 5]
// One thread; scenes take turns, the fastest of all rounds counts. "ratio" is to the first row of
// each block. test_skips holds the counters to what they must be.

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

#include "core/parallel.h"
#include "render/frame.h"
#include "restir/reuse_scenes.h"
#include "support/media.h"

namespace mote {
namespace {

constexpr int width = 240;
constexpr int height = 136;

struct Row {
    std::string name;
    Scene scene;
    bool repeated = false;  ///< the frame before was the same
    FrameStats best{};      ///< of the fastest round
};

void render(Row& row, int round)
{
    RenderDescription render;
    render.width = row.scene.camera.width;
    render.height = row.scene.camera.height;
    render.samples = 2;
    render.seed = static_cast<uint32_t>(round);
    render.estimator = EstimatorKind::Restir;
    FrameHistory history;
    for (int frame = row.repeated ? 0 : 1; frame < 2; ++frame) {
        FrameStats stats;
        row.scene.frame = frame;
        (void)render_frame(row.scene, render, {}, history, nullptr, stats);
        if (frame == 0) continue;
        const bool first = round == 0;
        if (first || stats.render_cpu_seconds < row.best.render_cpu_seconds) row.best = stats;
    }
}

void report(std::vector<Row> rows, int rounds)
{
    for (int round = 0; round < rounds; ++round) {
        for (Row& row : rows) render(row, round);
    }
    fmt::print(
        "{:26} {:>8} {:>8} {:>6}  {:>5} {:>5} {:>6} {:>9} {:>8} {:>8} {:>8} {:>9} {:>8} {:>8}\n",
        "", "CPU ms", "caches", "ratio", "maps", "sets", "l.cells", "emission", "camera", "missed",
        "light", "cells", "uniform", "built");
    const double base = rows.front().best.render_cpu_seconds;
    for (const Row& row : rows) {
        const FrameStats& s = row.best;
        fmt::print(
            "{:26} {:8.1f} {:8.1f} {:6.2f}  {:5} {:5} {:6} {:9} {:8} {:8} {:8} {:9} {:8} {:5}/{}\n",
            row.name, 1e3 * s.render_cpu_seconds, 1e3 * s.cache_cpu_seconds,
            s.render_cpu_seconds / base, s.caches.transmittance_maps, s.caches.direction_sets,
            s.caches.light_cells, s.emission_integrals, s.camera_rays, s.missed_rays, s.light_rays,
            s.cells, s.uniform_bricks, s.caches_built, s.caches_built + s.caches_reused);
    }
    fmt::print("\n");
    std::fflush(stdout);
}

Scene plume(const std::string& more, const std::string& lights,
            const std::string& camera = "position = [0, 0, 3.2]\nfov = 24")
{
    return test::frames_of(test::scene_text::image(width, height) + "[camera]\n" + camera +
                               "\n[[volumes]]\nprocedural = { type = \"puff\", size = 2.4, "
                               "voxel_size = 0.02, noise = 0.7 }\ndensity_scale = 4\n"
                               "albedo = 0.9\nphase = 0.3\n" +
                               more + lights,
                           1)
        .front();
}

const char* const sun = R"(
[[lights]]
type = "distant"
direction = [1, 1, 0.4]
)";
const char* const sky = R"(
[[lights]]
type = "environment"
strength = 0.4
)";
const char* const lamps = R"(
[[lights]]
type = "sphere"
count = 60
spread = [3, 3, 3]
radius = 0.05
)";

/// A cube of 96^3 voxels, without its sides.
Scene cube(const std::function<float(Vec3)>& density)
{
    Scene scene = plume("", sun);
    Volume volume = test::cube_volume(96, 2.0f, density);
    volume.density_scale = 2.0f;
    finalize(volume);
    scene.media.volumes = {volume};
    return scene;
}

void run(int rounds)
{
    const std::string glow = "emission = { scale = 1 }\n";
    report({{"no light", plume("", "")},
            {"sun", plume("", sun)},
            {"sky", plume("", sky)},
            {"60 lamps", plume("", lamps)},
            {"glow", plume(glow, "")},
            {"all four", plume(glow, std::string(sun) + sky + lamps)}},
           rounds);
    const std::string both = std::string(sun) + sky;
    report({{"sun and sky, all filled", plume("", both)},
            {"a quarter filled", plume("", both, "position = [0, 0, 8.6]\nfov = 24")},
            {"nothing in view", plume("", both, "position = [0, 0, 6]\nlook_at = [0, 0, 9]")}},
           rounds);
    report({{"all four, first frame", plume(glow, both + lamps)},
            {"the same again", plume(glow, both + lamps), true}},
           rounds);
    report({{"cube that varies", cube([](Vec3 p) { return 1.0f + 0.2f * std::sin(20.0f * p.z); })},
            {"cube of one value", cube([](Vec3) { return 1.0f; })}},
           rounds);
}

}  // namespace
}  // namespace mote

int main(int argc, char** argv)
{
    const int rounds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 5;
    mote::run_with_threads(1, [&] { mote::run(rounds); });
    return 0;
}
