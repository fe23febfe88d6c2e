#include <gtest/gtest.h>

#include "restir/reuse_scenes.h"
#include "restir/small_reuse.h"
#include "study/study.h"

// The mistakes of reuse that tests/restir/small_reuse.h can make, as runs of a study: what reuse
// adds to the mean of a pixel's own candidates stands beside those, whose mean is right, of other
// seeds.

namespace mote {
namespace {

using test::Fault;
using test::SmallReuse;
using Frames = std::vector<test::SmallFrame>;

constexpr float pedestal = 1.0f;

/// Red, green and blue of a run: what reuse changed, over a pedestal. The noise that it shares with
/// its own candidates is not in it, so that the bias shows within a few runs.
RunSource changes_of(const Frames& frames, const SmallReuse& how)
{
    return [&frames, how](uint32_t seed) {
        const auto pixels = test::SmallRun(how, seed).play(frames);
        LayeredImage image;
        image.width = frames.back().width;
        image.height = frames.back().height;
        for (int c = 0; c < 3; ++c) {
            Buffer2D<float> data(image.width, image.height);
            for (size_t i = 0; i < data.size(); ++i) {
                data.data()[i] = pedestal + pixels[i].color[c] - pixels[i].own_color[c];
            }
            image.channels.push_back({std::string(1, "RGB"[c]), PixelType::Float, data});
        }
        return image;
    };
}

/// Nothing is changed.
LayeredImage nothing_of(const Frames& frames)
{
    LayeredImage image;
    image.width = frames.back().width;
    image.height = frames.back().height;
    for (const char* name : {"R", "G", "B"}) {
        image.channels.push_back(
            {name, PixelType::Float, Buffer2D<float>(image.width, image.height, pedestal)});
    }
    return image;
}

Study study_of(const Frames& frames, const SmallReuse& how, int runs)
{
    const LayeredImage nothing = nothing_of(frames);
    StudyParams params;
    params.question.budget = 1e-4;
    params.question.tile_budget = 1e-3;
    params.question.alpha = 1e-4;
    params.tile_size = 2;
    params.most_runs = runs;
    return run_study(
        changes_of(frames, how), [&](uint32_t) { return nothing; }, params);
}

struct Control {
    std::string name;
    std::vector<Scene> (*scenes)(int count);
    int frame_count;
    SmallReuse how;
    int runs = 150;
};

void PrintTo(const Control& control, std::ostream* out)
{
    *out << control.name;
}

SmallReuse in_time(ShiftKind shift, Fault fault)
{
    SmallReuse how;
    how.shift = shift;
    how.temporal = true;
    how.fault = fault;
    return how;
}

SmallReuse in_space(ShiftKind shift, Fault fault)
{
    SmallReuse how;
    how.shift = shift;
    how.neighbours = 3;
    how.fault = fault;
    return how;
}

SmallReuse with_one_candidate(SmallReuse how)
{
    how.candidates = 1;
    return how;
}

class ReuseFaultStat : public testing::TestWithParam<Control> {};

TEST_P(ReuseFaultStat, IsFoundAndTheRightOneIsNot)
{
    const Control& control = GetParam();
    const Frames frames = test::small_frames(control.scenes(control.frame_count));
    const Study wrong = study_of(frames, control.how, control.runs);
    EXPECT_EQ(wrong.verdict(), Verdict::BiasFound) << wrong.last().reason;
    SmallReuse right = control.how;
    right.fault = Fault::None;
    const Study study = study_of(frames, right, control.runs);
    EXPECT_NE(study.verdict(), Verdict::BiasFound) << study.last().reason;
}

const Control controls[] = {
    {"W_one_percent_too_large", test::still_frames, 4,
     in_time(ShiftKind::RandomNumbers, Fault::ScaledW), 400},
    {"no_Jacobian", test::everything_moves_frames, 4, in_time(ShiftKind::World, Fault::NoJacobian),
     400},
    {"M_of_a_zero_target", test::dark_side_frames, 1,
     with_one_candidate(in_space(ShiftKind::RandomNumbers, Fault::EmptyIsNoInput))},
    {"stale_target", test::still_frames, 1, in_space(ShiftKind::RandomNumbers, Fault::DonorTarget)},
    {"density_of_now_for_then", test::everything_moves_frames, 4,
     in_time(ShiftKind::World, Fault::CurrentAsPrevious)},
    {"one_sided_rejection", test::evolving_smoke_frames, 4,
     in_time(ShiftKind::World, Fault::OneSidedRejection), 200},
    {"motion_of_the_own_sample", test::flight_around_frames, 4,
     in_time(ShiftKind::World, Fault::OwnSampleMotion), 200},
};

INSTANTIATE_TEST_SUITE_P(Faults, ReuseFaultStat, testing::ValuesIn(controls),
                         [](const testing::TestParamInfo<Control>& control) {
                             return control.param.name;
                         });

}  // namespace
}  // namespace mote
