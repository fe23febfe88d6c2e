// A small renderer of light of many events with reuse, written apart from the real one, and
// mistakes that it can make: they must be found out, and what is right must not be.

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "multiscatter/combine_paths.h"
#include "multiscatter/path_worlds.h"
#include "restir/reproject.h"
#include "restir/reuse_scenes.h"
#include "verify/p_values.h"
#include "verify/statistics.h"

namespace mote {
namespace {

enum class Fault {
    None,
    NoJacobian,   ///< of reconnection
    KeptM,        ///< a path that does not get here still leaves its share to others
    StaleSuffix,  ///< what history found stays, though the smoke has changed
    OwnAsBefore,  ///< the earlier domain is evaluated in the smoke of now
};

struct SmallPaths {
    const char* name;
    std::vector<Scene> (*frames)(int count);
    int frame_count;
    ShiftKind shift;
    Fault fault;
    int runs = 60;
};

/// For the names of tests.
void PrintTo(const SmallPaths& how, std::ostream* out)
{
    *out << how.name;
}

constexpr int max_bounces = 4;
constexpr int walks = 2;
constexpr float cap = 4.0f;

struct SmallPixel {
    PathPixel path;
    Spectrum light{0.0f};
    Spectrum own_light{0.0f};  ///< of the pixel's own walks: its mean is right
};

/// A frame's worlds and pixels.
struct SmallFrame {
    std::unique_ptr<test::PathScene> scene;
    std::vector<PixelDomain> pixels;
    int width = 0;
    int height = 0;
};

std::vector<SmallFrame> small_frames(const SmallPaths& how)
{
    std::vector<SmallFrame> out;
    for (const Scene& scene : how.frames(how.frame_count)) {
        SmallFrame frame{std::make_unique<test::PathScene>(scene, max_bounces),
                         {},
                         scene.camera.width,
                         scene.camera.height};
        frame.pixels.resize(static_cast<size_t>(frame.width * frame.height));
        for (int i = 0; i < frame.width * frame.height; ++i) {
            const Vec2 film = Vec2(i % frame.width, i / frame.width) + 0.5f;
            frame.scene->make_domain(film, frame.pixels[static_cast<size_t>(i)]);
        }
        out.push_back(std::move(frame));
    }
    return out;
}

void walk(const PathEndpoint& own, uint32_t frame, uint32_t i, SmallPixel& pixel)
{
    std::vector<DrawnPath> paths;
    float cut = 0.0f;
    Rng rng(own.world.seed, frame, Stream::Test, i, 0);
    for (uint32_t k = 0; k < walks; ++k) {
        const float u = (static_cast<float>(k) + rng.uniform()) / walks;
        draw_paths(own.world, own.domain, u, {frame, i, k}, paths, cut);
    }
    pixel.path = resample_paths(own, paths, 1.0f / walks, rng, pixel.own_light);
    pixel.light = pixel.own_light;
}

/// What make_other_path gives, with the fault.
OtherPath other_path(const SmallPaths& how, const PathReservoir& mine, const PathEndpoint& own,
                     const PathReservoir& other, const PathEndpoint& from, const PathMap& map)
{
    OtherPath out = make_other_path(mine, own, other, from, std::min(other.M, cap), map);
    if (how.fault == Fault::KeptM && !(out.own_there > 0.0f)) out.own_there = mine.p_hat;
    if (how.fault != Fault::NoJacobian) return out;
    MOTE_ASSERT(how.shift == ShiftKind::RandomNumbers);  // has no Jacobian beside
    out.here.jacobian = 1.0f;
    out.own_there = 0.0f;
    if (!(mine.W > 0.0f)) return out;
    const auto there = shift_path(mine.y, own, from, map.inverse());
    if (there) out.own_there = luminance(there->f);
    return out;
}

/// Combines with two pixels to the right and below.
void reuse_in_space(const SmallPaths& how, const SmallFrame& frame, const PathWorld& world,
                    std::vector<SmallPixel>& pixels, uint32_t number)
{
    const std::vector<SmallPixel> before = pixels;
    for (int i = 0; i < frame.width * frame.height; ++i) {
        std::vector<OtherPath> others;
        const auto at = static_cast<size_t>(i);
        const PathEndpoint own{world, frame.pixels[at]};
        for (const int j : {i + 2, i + 2 * frame.width}) {
            const auto there = static_cast<size_t>(j);
            if (there >= pixels.size() || frame.pixels[there].bins.empty()) continue;
            const PathEndpoint from{world, frame.pixels[there]};
            const PathMap map{how.shift, make_ray_map(from.domain.ray, own.domain.ray, Vec3(0.0f)),
                              Vec3(0.0f), SuffixRule::Kept};
            const PathReservoir& r = before[there].path.r;
            others.push_back(other_path(how, before[at].path.r, own, r, from, map));
        }
        Rng rng(world.seed, number, Stream::PathSpatial, static_cast<uint32_t>(i), 0);
        pixels[at].path =
            combine_paths(before[at].path, others, MisForm::Pairwise, rng, pixels[at].light);
    }
}

/// Combines with where each pixel was a frame ago.
void reuse_in_time(const SmallPaths& how, const SmallFrame& now, const PathWorld& world,
                   const SmallFrame& then, const PathWorld& earlier,
                   const std::vector<SmallPixel>& history, std::vector<SmallPixel>& pixels,
                   uint32_t number)
{
    for (size_t i = 0; i < pixels.size(); ++i) {
        const PathEndpoint own{world, now.pixels[i]};
        const auto from = previous_pixel(earlier.frame, world.frame, own.domain, true);
        if (!from) continue;
        const auto there = static_cast<size_t>(from->y * now.width + from->x);
        const PathWorld& old = how.fault == Fault::OwnAsBefore ? world : earlier;
        const PathEndpoint end{old, then.pixels[there]};
        const PathMap map{how.shift, make_ray_map(end.domain.ray, own.domain.ray, from->motion),
                          from->motion,
                          how.fault == Fault::StaleSuffix ? SuffixRule::Kept : SuffixRule::Traced};
        if (!map.ray.is_usable()) continue;
        const PathReservoir& r = history[there].path.r;
        const OtherPath other = other_path(how, pixels[i].path.r, own, r, end, map);
        Rng rng(world.seed, number, Stream::PathTemporal, static_cast<uint32_t>(i), 0);
        pixels[i].path =
            combine_paths(pixels[i].path, {&other, 1}, MisForm::Pairwise, rng, pixels[i].light);
    }
}

/// The last frame's pixels.
std::vector<SmallPixel> play(const SmallPaths& how, const std::vector<SmallFrame>& frames,
                             uint32_t seed)
{
    std::vector<SmallPixel> history;
    for (size_t n = 0; n < frames.size(); ++n) {
        const SmallFrame& frame = frames[n];
        PathWorld world = frame.scene->world();
        world.seed = seed;
        const auto number = static_cast<uint32_t>(n);
        std::vector<SmallPixel> pixels(frame.pixels.size());
        for (size_t i = 0; i < pixels.size(); ++i) {
            if (frame.pixels[i].bins.empty()) {
                pixels[i].path.r.M = 1.0f;
                continue;
            }
            walk({world, frame.pixels[i]}, number, static_cast<uint32_t>(i), pixels[i]);
        }
        if (frames.size() == 1) {
            reuse_in_space(how, frame, world, pixels, number);
        } else if (n > 0) {
            PathWorld earlier = frames[n - 1].scene->world();
            earlier.seed = seed;
            reuse_in_time(how, frame, world, frames[n - 1], earlier, history, pixels, number);
        }
        history = std::move(pixels);
    }
    return history;
}

/// Student's tests of what reuse adds to the light of a pixel's own walks: whole image and quarters
/// of it, corrected for their number. Both share the walks, so much of their noise cancels.
double judge(const SmallPaths& how)
{
    const std::vector<SmallFrame> frames = small_frames(how);
    const int width = frames.back().width;
    const int height = frames.back().height;
    constexpr int parts = 5;
    RunningStats added[parts];
    RunningStats own;
    for (int run = 0; run < how.runs; ++run) {
        double sums[parts]{};
        double own_sum = 0.0;
        const std::vector<SmallPixel> pixels = play(how, frames, static_cast<uint32_t>(run));
        for (int i = 0; i < width * height; ++i) {
            const SmallPixel& pixel = pixels[static_cast<size_t>(i)];
            const auto more = static_cast<double>(luminance(pixel.light - pixel.own_light));
            sums[2 * (i % width) / width + 2 * (2 * (i / width) / height)] += more;
            sums[4] += more;
            own_sum += static_cast<double>(luminance(pixel.own_light));
        }
        for (int part = 0; part < parts; ++part) added[part].add(sums[part]);
        own.add(own_sum);
    }
    double p = 1.0;
    for (const RunningStats& part : added) {
        p = std::min(p, test_zero(estimate_mean(part), 1e-5 * own.mean).p);
        if (std::getenv("MOTE_REPORT")) {
            std::printf("%-28s %d %+.2f +- %.2f %%  p %.2g\n", how.name,
                        static_cast<int>(how.fault), 100.0 * part.mean / own.mean,
                        100.0 * part.standard_error() / own.mean,
                        test_zero(estimate_mean(part), 1e-5 * own.mean).p);
        }
    }
    return sidak_p(p, parts);
}

/// Rate at which a right variant is rejected by chance, and a wrong one must be.
constexpr double alarm = 1e-5;

class PathControlStat : public testing::TestWithParam<SmallPaths> {};

TEST_P(PathControlStat, IsFoundOut)
{
    EXPECT_LT(judge(GetParam()), alarm);
    SmallPaths right = GetParam();
    right.fault = Fault::None;
    EXPECT_GT(judge(right), alarm);
}

const SmallPaths controls[] = {
    {"no Jacobian", test::still_frames, 1, ShiftKind::RandomNumbers, Fault::NoJacobian, 600},
    {"M kept after a failed shift", test::everything_moves_frames, 3, ShiftKind::World,
     Fault::KeptM, 400},
    {"stale suffix, lights", test::changing_lights_frames, 3, ShiftKind::RandomNumbers,
     Fault::StaleSuffix, 300},
    {"stale suffix, smoke", test::burst_frames, 3, ShiftKind::World, Fault::StaleSuffix, 400},
    {"smoke of now for then", test::everything_moves_frames, 3, ShiftKind::World,
     Fault::OwnAsBefore, 300},
};

INSTANTIATE_TEST_SUITE_P(Controls, PathControlStat, testing::ValuesIn(controls),
                         [](const testing::TestParamInfo<SmallPaths>& control) {
                             std::string name = control.param.name;
                             for (char& c : name) {
                                 if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
                             }
                             return name;
                         });

}  // namespace
}  // namespace mote
