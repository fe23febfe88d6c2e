// What reuse is worth: relative variance and CPU time of one shown frame after eight others, for
// every mode, shift and strength of validation, at rest and in motion.
//   bench_reuse [runs = 12] [still | camera | smoke]
// Efficiency is 1 / (variance * CPU time) over that without reuse, in the same scene and run. Light
// caches are shared and not counted.

#include <cstdlib>

#include <fmt/format.h>

#include "restir/reuse_modes.h"
#include "restir/reuse_runs.h"
#include "restir/reuse_scenes.h"

namespace mote {
namespace {

constexpr int warm_up = 8;

/// 32 x 24 pixels, about one voxel each.
std::vector<Scene> frames_of_bench(const char* camera, const std::string& evolve,
                                   const std::string& transform, const char* lamps)
{
    using namespace test::scene_text;
    return test::frames_of(
        image(32, 24) + camera +
            "[[volumes]]\nprocedural = { type = \"puff\", voxel_size = 0.03, noise = 0.9" + evolve +
            " }\ndensity_scale = 9\nalbedo = 0.9\nphase = 0.3\n" + transform + lamps,
        warm_up + 1);
}

struct Measured {
    double variance = 0.0;  ///< of a pixel, mean over the image, over the squared mean
    double mean = 0.0;
    double cpu_us = 0.0;  ///< per pixel
};

Measured measure(const std::vector<Scene>& frames, const test::FrameCaches& caches,
                 const RestirParams& restir, int runs)
{
    RenderDescription render;
    render.samples = 1;
    render.estimator = EstimatorKind::Restir;
    render.restir = restir;
    const OutputDescription output = test::direct_light_output();
    TileStats stats(1);
    double cpu = 0.0;
    const size_t first = restir.reuse == ReuseMode::Temporal || restir.reuse == ReuseMode::Both
                             ? 0
                             : frames.size() - 1;
    for (int run = 0; run < runs; ++run) {
        render.seed = static_cast<uint32_t>(run);
        FrameHistory history;
        for (size_t i = first; i < frames.size(); ++i) {
            history.impl().caches = caches[i];
            FrameStats frame_stats;
            LayeredImage image =
                render_frame(frames[i], render, output, history, nullptr, frame_stats);
            if (i + 1 < frames.size()) continue;
            cpu += frame_stats.render_cpu_seconds;
            add_run(stats, test::direct_light_only(std::move(image)));
        }
    }
    Measured out;
    const TileStats::ChannelStats& green = stats.channels[1];
    for (const RunningStats& pixel : green.tiles) out.variance += pixel.variance();
    const auto pixels = static_cast<double>(green.tiles.size());
    out.mean = green.whole_image.mean;
    out.variance /= pixels * out.mean * out.mean;
    out.cpu_us = 1e6 * cpu / (runs * pixels);
    return out;
}

void report(const std::string& name, const std::vector<Scene>& frames, bool in_motion, int runs)
{
    const test::FrameCaches caches = test::make_frame_caches(frames);
    Measured off;
    const auto row = [&](const std::string& mode, RestirParams restir) {
        restir.candidates = 8;
        const Measured m = measure(frames, caches, restir, runs);
        if (restir.reuse == ReuseMode::Off) off = m;
        fmt::print(
            "{:13} {:32} variance {:7.4f}  {:5.1f} us/pixel  efficiency {:5.2f}  mean {:.4f}\n",
            name, mode, m.variance, m.cpu_us, off.variance * off.cpu_us / (m.variance * m.cpu_us),
            m.mean);
        std::fflush(stdout);
    };
    for (const test::ReuseCase& each : test::all_reuse_cases()) {
        row(each.name, each.params);
        const ReuseMode reuse = each.params.reuse;
        if (!in_motion && reuse == ReuseMode::Temporal) {
            RestirParams restir = each.params;
            restir.mis = ReuseMis::Pairwise;
            row(each.name + " pairwise", restir);
            restir.temporal.cap = 4.0f;
            row(each.name + " pairwise cap 4", restir);
            restir.mis = ReuseMis::Balance;
            row(each.name + " balance cap 4", restir);
        }
        if (!in_motion || (reuse != ReuseMode::Temporal && reuse != ReuseMode::Both)) continue;
        for (const float validation : {0.0f, 4.0f}) {
            RestirParams restir = each.params;
            restir.temporal.validation = validation;
            row(fmt::format("{} validation {}", each.name, validation), restir);
        }
        if (reuse != ReuseMode::Temporal) continue;
        for (const float cap : {1.0f, 8.0f}) {
            RestirParams restir = each.params;
            restir.temporal.cap = cap;
            row(fmt::format("{} cap {}", each.name, cap), restir);
        }
    }
}

}  // namespace
}  // namespace mote

int main(int argc, char** argv)
{
    using namespace mote;
    const int runs = argc > 1 ? std::atoi(argv[1]) : 12;
    using namespace test::scene_text;
    const char* const slow_camera = R"([camera]
fov = 21
keys = [ { frame = 1, position = [-0.3, 0, 2.6], look_at = [0, 0, 0] },
         { frame = 9, position = [0.3, 0.1, 2.4], look_at = [0, 0, 0] } ]
)";
    const char* const slow_flight = R"(transform = [ { frame = 1, translate = [-0.1, -0.1, 0] },
                                                      { frame = 9, translate = [0.1, 0.1, 0] } ]
)";
    const char* const lamps_around = R"(
[[lights]]
type = "sphere"
count = 60
spread = [4, 4, 4]
radius = 0.05
strength = 3
)";
    const std::string wanted = argc > 2 ? argv[2] : "";
    for (const bool inside : {true, false}) {
        const char* const lamps = inside ? nine_lamps : lamps_around;
        const char* const where = inside ? "inside" : "around";
        const auto play = [&](const char* motion, const char* camera, const char* evolve,
                              const char* transform) {
            if (!wanted.empty() && wanted != motion) return;
            report(fmt::format("{} {}", where, motion),
                   frames_of_bench(camera, evolve, transform, lamps),
                   std::string(motion) != "still", runs);
        };
        play("still", still_camera, "", "");
        play("camera", slow_camera, "", "");
        play("smoke", still_camera, ", evolve = 1.5", slow_flight);
    }
    return 0;
}
