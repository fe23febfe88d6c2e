#include <gtest/gtest.h>

#include "multiscatter/batches.h"
#include "multiscatter/cached_lights.h"
#include "reference/path_tracer.h"
#include "restir/scenes.h"

namespace mote {
namespace {

constexpr double alarm = 1e-5;

/// Lamp 0 with half of the probability, the others alike. What it says of lamp 0 may be a lie.
class OddGuide final : public LightGuide {
  public:
    OddGuide(int lamps, float said) : lamps_(lamps), said_(said) {}
    [[nodiscard]] Choice choose(Vec3 x, double u) const override
    {
        const int lamp =
            u < 0.5 ? 0 : 1 + static_cast<int>((2.0 * u - 1.0) * static_cast<double>(lamps_ - 1));
        return {lamp, pmf(lamp, x)};
    }
    [[nodiscard]] float pmf(int lamp, Vec3) const override
    {
        return lamp == 0 ? said_ : 0.5f / static_cast<float>(lamps_ - 1);
    }

  private:
    int lamps_;
    float said_;
};

constexpr int lamp_count = 12;

Scene lamps()
{
    Scene scene = test::lit_clumps(3.0f);
    for (uint32_t i = 0; i < lamp_count; ++i) {
        Rng rng(5, 0, Stream::Test, i, 0);
        const Vec3 p = 2.0f * (rng.uniform3() - Vec3(0.5f));
        scene.lights.emplace_back(SphereLight{p, 0.1f, Spectrum(1.0f + 3.0f * rng.uniform())});
    }
    return scene;
}

MeanEstimate mean_with(const Scene& scene, const LightGuide* guide, uint32_t seed)
{
    PathTracerParams path;
    path.max_bounces = 3;
    const LightSampler lights(scene, path);
    const TraceContext context{scene, lights, path, nullptr, guide};
    const ScatterEvent event{Vec3(0.1f, 0.05f, 0.2f), glm::normalize(Vec3(0.4f, 0.3f, 3.0f)), 0.0f,
                             &scene.media.volumes[0].phase};
    return test::mean_of({32, 1500}, seed,
                         [&](Rng& rng) { return trace_after_event(context, event, rng).indirect; });
}

TEST(LightGuideStat, AnyGuideLeavesTheMeanAndALieIsFoundOut)
{
    const Scene scene = lamps();
    const MeanEstimate alone = mean_with(scene, nullptr, 1);
    const OddGuide odd(lamp_count, 0.5f);
    EXPECT_GT(welch_test(mean_with(scene, &odd, 2), alone).p, alarm);
    const OddGuide lie(lamp_count, 0.1f);
    EXPECT_LT(welch_test(mean_with(scene, &lie, 3), alone).p, alarm);
}

TEST(LightGuideStat, LightCellsLeaveTheMean)
{
    const Scene scene = lamps();
    const auto caches = make_light_caches(scene, {}, nullptr);
    const CachedGuesses guesses(*caches);
    ASSERT_TRUE(guesses.guide());
    EXPECT_GT(welch_test(mean_with(scene, guesses.guide(), 4), mean_with(scene, nullptr, 1)).p,
              alarm);
}

}  // namespace
}  // namespace mote
