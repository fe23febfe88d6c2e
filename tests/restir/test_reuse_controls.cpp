#include <cstdio>

#include <fmt/format.h>

#include "restir/reuse_runs.h"
#include "restir/reuse_scenes.h"
#include "restir/small_reuse.h"

namespace mote {
namespace {

using test::Fault;
using test::SmallReuse;

/// What reuse adds to the mean of the pixels' own candidates, over independent runs: whole image
/// and quarters of it. Both come from the same candidates, so much of their noise cancels.
struct Verdict {
    double relative = 0.0;  ///< of the whole image
    double standard_error = 0.0;
    double p = 1.0;  ///< the smaller of whole image and quarters, corrected for their number
};

Verdict judge(const std::vector<test::SmallFrame>& frames, const SmallReuse& how, int runs)
{
    RunningStats whole;
    RunningStats own;
    RunningStats quarters[4];
    const int width = frames.back().width;
    const int height = frames.back().height;
    for (int run = 0; run < runs; ++run) {
        const auto pixels = test::SmallRun(how, static_cast<uint32_t>(run)).play(frames);
        double added[4] = {};
        double sum = 0.0;
        for (int i = 0; i < width * height; ++i) {
            const test::SmallPixel& pixel = pixels[static_cast<size_t>(i)];
            const int quarter = (2 * (i % width) / width) + 2 * (2 * (i / width) / height);
            added[quarter] += static_cast<double>(luminance(pixel.color - pixel.own_color));
            sum += static_cast<double>(luminance(pixel.own_color));
        }
        whole.add(added[0] + added[1] + added[2] + added[3]);
        own.add(sum);
        for (int q = 0; q < 4; ++q) quarters[q].add(added[q]);
    }
    Verdict verdict;
    verdict.relative = whole.mean / own.mean;
    verdict.standard_error = whole.standard_error() / own.mean;
    const double rounding = 1e-5 * own.mean;
    double p_quarter = 1.0;
    for (const RunningStats& q : quarters) {
        p_quarter = std::min(p_quarter, test_zero(estimate_mean(q), rounding).p);
    }
    const double p_whole = test_zero(estimate_mean(whole), rounding).p;
    verdict.p = std::min(1.0, 2.0 * std::min(p_whole, sidak_p(p_quarter, 4)));
    return verdict;
}

/// Rate at which a right variant is rejected by chance, and a wrong one must be.
constexpr double alpha = 1e-5;

struct Control {
    std::string name;
    std::vector<Scene> (*frames)(int count);
    int frame_count = 4;
    SmallReuse how;
    int runs = 150;
};

void PrintTo(const Control& control, std::ostream* out)
{
    *out << control.name;
}

SmallReuse in_time(ShiftKind shift, Fault fault, MisForm mis = MisForm::Pairwise)
{
    SmallReuse how;
    how.shift = shift;
    how.mis = mis;
    how.temporal = true;
    how.fault = fault;
    return how;
}

SmallReuse in_space(ShiftKind shift, Fault fault, MisForm mis = MisForm::Pairwise)
{
    SmallReuse how;
    how.shift = shift;
    how.mis = mis;
    how.neighbours = 3;
    how.fault = fault;
    return how;
}

constexpr ShiftKind numbers = ShiftKind::RandomNumbers;
constexpr ShiftKind world = ShiftKind::World;

SmallReuse with_one_candidate(SmallReuse how)
{
    how.candidates = 1;
    return how;
}
SmallReuse with_cap(SmallReuse how, float cap)
{
    how.cap = cap;
    return how;
}

class ReuseControlStat : public testing::TestWithParam<Control> {};

/// The fault is seen, and what it is seen with sees nothing where there is no fault.
TEST_P(ReuseControlStat, IsRejectedAndTheRightOneIsNot)
{
    const Control& control = GetParam();
    const auto frames = test::small_frames(control.frames(control.frame_count));
    const Verdict wrong = judge(frames, control.how, control.runs);
    SmallReuse how = control.how;
    how.fault = Fault::None;
    if (how.mis == MisForm::Constant) how.mis = MisForm::Pairwise;
    const Verdict right = judge(frames, how, control.runs);
    const std::string row = fmt::format(
        "{:28} wrong {:+7.2f} +- {:4.2f} %  p {:8.2g}   right {:+6.2f} +- {:4.2f} %  p {:8.2g}",
        control.name, 100.0 * wrong.relative, 100.0 * wrong.standard_error, wrong.p,
        100.0 * right.relative, 100.0 * right.standard_error, right.p);
    if (std::getenv("MOTE_REPORT")) std::printf("%s\n", row.c_str());
    EXPECT_LT(wrong.p, alpha) << row;
    EXPECT_GT(right.p, alpha) << row;
}

/// Where the image is symmetric a Jacobian that is left out cancels between neighbours, so it is
/// looked for in time alone (test_shift.cpp compares it with differences).
const Control controls[] = {
    {"constant weights in space", test::still_frames, 1,
     in_space(world, Fault::None, MisForm::Constant)},
    {"constant weights in time", test::everything_moves_frames, 4,
     in_time(world, Fault::None, MisForm::Constant)},
    {"no Jacobian", test::everything_moves_frames, 4, in_time(world, Fault::NoJacobian), 200},
    {"smoke of now for then", test::everything_moves_frames, 4,
     in_time(world, Fault::CurrentAsPrevious)},
    {"target of the donor", test::still_frames, 1, in_space(numbers, Fault::DonorTarget)},
    {"visibility of the donor", test::still_frames, 1, in_space(numbers, Fault::DonorVisibility)},
    {"visibility of before", test::everything_moves_frames, 4,
     in_time(numbers, Fault::DonorVisibility)},
    {"normalisation of the donor", test::still_frames, 1,
     in_space(numbers, Fault::DonorNormalisation)},
    {"empty is no input", test::dark_side_frames, 1,
     with_one_candidate(in_space(numbers, Fault::EmptyIsNoInput))},
    {"one-sided rejection, numbers", test::flying_smoke_frames, 4,
     with_one_candidate(in_time(numbers, Fault::OneSidedRejection)), 1000},
    {"one-sided rejection, world", test::evolving_smoke_frames, 4,
     in_time(world, Fault::OneSidedRejection), 200},
    {"motion of the own sample", test::flight_around_frames, 4,
     in_time(world, Fault::OwnSampleMotion), 200},
    {"W one per cent too large", test::still_frames, 4, in_time(numbers, Fault::ScaledW), 400},
    {"sum kept, M stops at 20", test::still_frames, 30,
     with_cap(in_time(numbers, Fault::SumKept), 20.0f), 30},
};

INSTANTIATE_TEST_SUITE_P(Controls, ReuseControlStat, testing::ValuesIn(controls),
                         [](const testing::TestParamInfo<Control>& control) {
                             std::string name = control.param.name;
                             for (char& c : name) {
                                 if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
                             }
                             return name;
                         });

}  // namespace
}  // namespace mote
