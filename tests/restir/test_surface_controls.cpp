#include <gtest/gtest.h>

#include <fmt/format.h>

#include "restir/combine.h"
#include "restir/domains.h"
#include "restir/neighbours.h"
#include "restir/room_scenes.h"
#include "verify/statistics.h"

namespace mote {
namespace {

using test::RoomState;

/// What is done wrongly when surfaces reuse samples.
enum class Fault {
    None,
    DonorTarget,       ///< samples are shaded as at the pixel they come from
    NoVisibility,      ///< and as if nothing were in the way
    ZeroTargetCounts,  ///< confidence counts where a pixel could not have made the sample
    StaleTarget,       ///< last frame's samples are weighed by this frame's lights
};

struct Control {
    std::string name;
    Fault fault = Fault::None;
    bool in_time = false;  ///< else between neighbours
};

void PrintTo(const Control& control, std::ostream* out)
{
    *out << control.name;
}

constexpr int width = 8;
constexpr int height = 6;

/// A frame of a room and each pixel's surface, seen along the middle of the pixel.
struct RoomFrame {
    FrameDomain frame;
    std::vector<SurfaceDomain> surfaces;

    explicit RoomFrame(const RoomState& state)
    {
        const auto scene = std::make_shared<const Scene>(test::room(state));
        frame = make_frame_domain(scene, make_light_caches(*scene, {100'000}, nullptr), {});
        for (int i = 0; i < width * height; ++i) {
            PixelDomain domain;
            BinCounts counts;
            const Vec2 film = Vec2(i % width, i / width) + 0.5f;
            make_pixel_domain(frame, generate_ray(frame.scene->camera, film, Vec2(0.5f), 0.0f),
                              domain, counts);
            surfaces.push_back(make_surface_domain(frame, domain, 0.0f));
        }
    }
};

/// Each pixel's own reservoir with its exact shadow.
std::vector<PixelReservoir> initial(const RoomFrame& room, uint32_t run, uint32_t pass)
{
    std::vector<PixelReservoir> out;
    LightRays rays;
    std::vector<Candidate> candidates;
    for (size_t i = 0; i < room.surfaces.size(); ++i) {
        Rng rng(run, pass, Stream::Test, static_cast<uint32_t>(i), 0);
        candidates.clear();
        draw_surface_candidates(room.frame, room.surfaces[i], rng, candidates);
        Spectrum unshadowed;
        out.push_back(resample(candidates, rng, unshadowed));
        if (!(out.back().r.W > 0.0f)) continue;
        const Candidate c = evaluate(room.frame, room.surfaces[i], out.back().r.y);
        rays.add(static_cast<int>(i), c.x, c.arrival.wi, c.arrival.distance, 0.0f, c.f, infinity);
    }
    WalkCounts counts;
    rays.trace(*room.frame.scene, counts);
    for (size_t i = 0; i < rays.size(); ++i) {
        PixelReservoir& own = out[static_cast<size_t>(rays.owners[i])];
        own.f = rays.value(i);
        own.r.p_hat = luminance(own.f);
        if (!(own.r.p_hat > 0.0f)) own.r.W = 0.0f;
    }
    return out;
}

CombineRules rules_of(Fault fault)
{
    CombineRules rules;
    if (fault == Fault::ZeroTargetCounts) rules.mis = MisForm::Constant;
    if (fault == Fault::NoVisibility) rules.visibility = TargetVisibility::None;
    return rules;
}

/// What reuse adds to the mean of the image's own samples in one run, and that mean.
struct Outcome {
    double added = 0.0;
    double own = 0.0;
};

Outcome play(const RoomFrame& before, const RoomFrame& now, const Control& control, uint32_t run)
{
    const std::vector<PixelReservoir> own = initial(now, run, 1);
    const std::vector<PixelReservoir> old = control.in_time ? initial(before, run, 0) : own;
    const RoomFrame& donors = control.in_time ? before : now;
    const FrameDomain& donor_frame = control.fault == Fault::StaleTarget ? now.frame : donors.frame;
    Combination combination(rules_of(control.fault));
    const auto add = [&](size_t i, size_t j) {
        const SurfaceDomain& here = now.surfaces[i];
        const SurfaceDomain& there = donors.surfaces[j];
        const bool as_donor = control.fault == Fault::DonorTarget;
        combination.add_other({now.frame, as_donor ? there : here}, {donor_frame, there}, old[j].r,
                              old[j].r.M);
    };
    for (int i = 0; i < width * height; ++i) {
        combination.begin_pixel(own[static_cast<size_t>(i)]);
        if (control.in_time) {
            add(static_cast<size_t>(i), static_cast<size_t>(i));
            continue;
        }
        for_each_neighbour(
            i % width, i / width, width, height, 3, 2.0f, static_cast<float>(run),
            [&](int x, int y) { add(static_cast<size_t>(i), static_cast<size_t>(y * width + x)); });
    }
    WalkCounts walks;
    combination.trace(*now.frame.scene, *donor_frame.scene, walks);
    Outcome out;
    for (int i = 0; i < width * height; ++i) {
        Rng rng(run, 2, Stream::Test, static_cast<uint32_t>(i), 0);
        Spectrum color;
        (void)combination.finish(i, rng, color);
        const PixelReservoir& mine = own[static_cast<size_t>(i)];
        const double alone =
            mine.r.W > 0.0f ? static_cast<double>(mine.r.W * luminance(mine.f)) : 0.0;
        out.own += alone;
        out.added += static_cast<double>(luminance(color)) - alone;
    }
    return out;
}

struct Verdict {
    double relative = 0.0;
    double p = 1.0;
    std::string text;
};

Verdict judge(const RoomFrame& before, const RoomFrame& now, const Control& control, int runs)
{
    RunningStats added;
    RunningStats own;
    for (int run = 0; run < runs; ++run) {
        const Outcome outcome = play(before, now, control, static_cast<uint32_t>(run));
        added.add(outcome.added);
        own.add(outcome.own);
    }
    Verdict out;
    out.relative = added.mean / own.mean;
    out.p = test_zero(estimate_mean(added), 1e-5 * own.mean).p;
    out.text = fmt::format("{:28} {:+7.2f} +- {:4.2f} %  p {:8.2g}", control.name,
                           100.0 * out.relative, 100.0 * added.standard_error() / own.mean, out.p);
    return out;
}

/// Rate at which the right one is rejected by chance, and a wrong one must be.
constexpr double alpha = 1e-5;

class SurfaceControlStat : public testing::TestWithParam<Control> {};

TEST_P(SurfaceControlStat, IsRejectedAndTheRightOneIsNot)
{
    const Control& wrong = GetParam();
    RoomState dim;
    dim.panel = 0.5f;
    dim.lamp_radiance = 20.0f;
    const RoomFrame before(dim);
    const RoomFrame now((RoomState()));
    constexpr int runs = 4000;
    const Verdict verdict = judge(before, now, wrong, runs);
    const Verdict right = judge(before, now, {"right", Fault::None, wrong.in_time}, runs);
    if (std::getenv("MOTE_REPORT"))
        std::printf("%s\n%s\n", verdict.text.c_str(), right.text.c_str());
    EXPECT_LT(verdict.p, alpha) << verdict.text;
    EXPECT_GT(right.p, alpha) << right.text;
}

const Control controls[] = {
    {"target of the donor", Fault::DonorTarget},
    {"no visibility", Fault::NoVisibility},
    {"zero target counts", Fault::ZeroTargetCounts},
    {"stale target", Fault::StaleTarget, true},
    {"no visibility in time", Fault::NoVisibility, true},
};

INSTANTIATE_TEST_SUITE_P(Controls, SurfaceControlStat, testing::ValuesIn(controls),
                         [](const testing::TestParamInfo<Control>& control) {
                             std::string name = control.param.name;
                             for (char& c : name) {
                                 if (c == ' ') c = '_';
                             }
                             return name;
                         });

}  // namespace
}  // namespace mote
