#include "restir/hard_reuse_scenes.h"
#include "restir/reuse_judge.h"

// The bias of the whole image, resolved as finely as can be afforded: finer than pixels and tiles
// show. The resolution reached is asserted as well, so too few runs cannot pass.

namespace mote {
namespace {

using test::SceneCase;

/// How sharply to look.
struct Sharpness {
    double resolution;               ///< relative bias that is found with probability 0.9
    double scale;                    ///< of an image that must be rejected
    double more = 1.0;               ///< times the samples of a BiasCase
    double alpha = 1e-3;             ///< false-alarm rate of one comparison
    static constexpr int runs = 40;  ///< independent runs of many samples each
};

/// A scene's last frame, by one way to sample it, and the samples that 0.6 percent take.
struct BiasCase {
    SceneCase scene;
    ReuseMode reuse = ReuseMode::Off;
    int reference_samples = 800;  ///< per pixel and run, of the path tracer
    int samples = 16;             ///< per pixel and run, without reuse
    int reusing_runs = 0;         ///< of one pass per frame, with it and without
};

void PrintTo(const BiasCase& each, std::ostream* out)
{
    *out << each.scene.name;
}

/// The whole image's green.
MeanEstimate mean_of(const TileStats& runs)
{
    return estimate_mean(runs.find("volume_direct.G")->whole_image);
}

MeanEstimate scaled(const MeanEstimate& mean, double factor)
{
    return {mean.mean * factor, mean.variance * factor * factor, mean.freedom};
}

/// For people: a part's noise and cost.
std::string part_text(const char* name, const MeanEstimate& part, double truth, double start)
{
    return fmt::format("   {} +- {:.3f} % in {:.1f} s", name, 100.0 * part.standard_error() / truth,
                       process_cpu_seconds() - start);
}

/// The mean with reuse is that without plus what reuse adds to the same candidates: the former
/// needs many samples, but no history; the latter has little noise.
void expect_no_bias(const BiasCase& each, const Sharpness& sharpness)
{
    const auto times = [&](int count) {
        return static_cast<int>(std::lround(sharpness.more * count));
    };
    const std::vector<Scene> frames = each.scene.frames(3);
    const test::FrameCaches caches = test::make_frame_caches(frames);
    RestirParams params = test::reuse_params(ReuseMode::Off, ShiftKind::RandomNumbers);
    params.control_variate = each.scene.control_variate;

    double start = process_cpu_seconds();
    const MeanEstimate truth = mean_of(test::path_traced_runs(
        frames.back(), times(each.reference_samples), {Sharpness::runs, 1'000'000}));
    std::string parts = part_text("path tracer", truth, truth.mean, start);
    start = process_cpu_seconds();
    MeanEstimate tested = mean_of(
        test::play_runs(frames, caches, params, {Sharpness::runs, 1, times(each.samples)}).images);
    parts += part_text("no reuse", tested, truth.mean, start);
    if (each.reuse != ReuseMode::Off) {
        start = process_cpu_seconds();
        params.reuse = each.reuse;
        const MeanEstimate added = mean_of(
            test::play_runs(frames, caches, params, {times(each.reusing_runs), 2'000'000}).added);
        parts += part_text("added", added, truth.mean, start);
        tested = combine(tested, 1.0, added, 1.0);
    }
    const TestResult result = welch_test(tested, truth);
    const double smallest =
        smallest_detectable_bias(result.difference, sharpness.alpha, 0.9) / truth.mean;
    const std::string row = fmt::format(
        "{:20} {:+7.3f} +- {:5.3f} %  z {:+5.2f}  p {:6.2g}  smallest detectable {:.3f} %{}",
        each.scene.name, 100.0 * result.difference.mean / truth.mean,
        100.0 * result.difference.standard_error() / truth.mean, result.t, result.p,
        100.0 * smallest, parts);
    if (std::getenv("MOTE_REPORT")) std::printf("%s\n", row.c_str());
    EXPECT_GT(result.p, sharpness.alpha) << row;
    EXPECT_LE(smallest, sharpness.resolution) << row;
    for (const double factor : {1.0 - sharpness.scale, 1.0 + sharpness.scale}) {
        EXPECT_LT(welch_test(scaled(tested, factor), truth).p, sharpness.alpha)
            << factor << ": " << row;
    }
}

/// Light at infinity by its closed form and by reuse; reuse of a lamp beside it, with the sharpest
/// phase functions; thick smoke.
const BiasCase cases[] = {
    {{"sun and sky", test::sun_and_sky_frames}, ReuseMode::Off, 850, 20},
    {{"reused sky", test::sun_and_sky_frames, false}, ReuseMode::Temporal, 1300, 200, 900},
    {{"backward", test::backward_frames}, ReuseMode::Both, 650, 20, 40},
    {{"forward", test::forward_frames}, ReuseMode::Both, 1000, 45, 40},
    {{"thick", test::thick_frames}, ReuseMode::Temporal, 1200, 180, 700},
};

class OverallBiasStat : public testing::TestWithParam<BiasCase> {};

/// Five comparisons: false once in 200 sets of seeds.
TEST_P(OverallBiasStat, IsBelowThePercent)
{
    expect_no_bias(GetParam(), {0.006, 0.01});
}

class OverallBiasLong : public testing::TestWithParam<BiasCase> {};

TEST_P(OverallBiasLong, IsBelowTheThousandth)
{
    if (!test::runs_long_tests()) GTEST_SKIP() << "MOTE_LONG_TESTS=1 runs it";
    expect_no_bias(GetParam(), {0.001, 0.003, 36.0});
}

std::string name_of(const testing::TestParamInfo<BiasCase>& info)
{
    return test::scene_case_name({info.param.scene, info.index});
}

INSTANTIATE_TEST_SUITE_P(Scenes, OverallBiasStat, testing::ValuesIn(cases), name_of);
INSTANTIATE_TEST_SUITE_P(Scenes, OverallBiasLong, testing::ValuesIn(cases), name_of);

}  // namespace
}  // namespace mote
