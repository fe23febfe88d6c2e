#include <gtest/gtest.h>

#include "multiscatter/batches.h"
#include "multiscatter/paired_paths.h"
#include "restir/room_scenes.h"

namespace mote {
namespace {

/// False alarms of each comparison, over seeds: Welch's test of two means.
constexpr double alarm = 1e-5;

struct PairCase {
    const char* name;
    Scene scene;
    Vec3 here, there;
    PairedPathParams params;
    int max_bounces = 6;
};

void PrintTo(const PairCase& c, std::ostream* out)
{
    *out << c.name;
}

PairedEvent event_at(const Scene& scene, Vec3 x, size_t volume, float weight)
{
    return {x, glm::normalize(Vec3(0.5f, 0.4f, 3.2f) - x), &scene.media.volumes[volume].phase,
            weight * Spectrum(0.9f, 0.8f, 0.7f)};
}

std::vector<PairCase> cases()
{
    const Scene open = test::sun_and_sky().scene;
    const Scene yard = test::courtyard(true);
    const Scene room = test::room();
    Scene narrow = open;
    narrow.media.volumes[0].phase = {0.85f, -0.3f, 0.1f};
    Scene two = test::overlapping().scene;
    two.lights = {test::sun()};
    const Vec3 x(0.1f, 0.05f, 0.2f);
    return {{"close", open, x, x + Vec3(0.02f, 0.01f, 0.0f), {0.1f}},
            {"apart", open, x, x + Vec3(0.3f, -0.2f, 0.1f), {0.3f}},
            {"one_place_only", open, x, x + Vec3(0.1f, 0.0f, 0.1f), {0.0f}},
            {"narrow_lobes", narrow, x, x + Vec3(0.04f, 0.0f, 0.02f), {0.3f}},
            {"two_events", open, x, x + Vec3(0.1f, 0.05f, 0.0f), {0.2f}, 2},
            {"different_phase_functions", two, x, x + Vec3(0.1f, 0.0f, 0.1f), {0.1f, false}},
            {"yard", yard, x, x + Vec3(0.1f, -0.1f, 0.1f), {0.2f}},
            {"room", room, x, x + Vec3(-0.1f, 0.1f, 0.05f), {0.2f}, 3}};
}

class PairedPathsStat : public testing::TestWithParam<PairCase> {};

TEST_P(PairedPathsStat, AverageToTheDifference)
{
    const PairCase& c = GetParam();
    PathTracerParams path;
    path.max_bounces = c.max_bounces;
    const LightSampler lights(c.scene, path);
    const TraceContext context{c.scene, lights, path};
    const size_t last = c.scene.media.volumes.size() - 1;
    const PairedEvent here = event_at(c.scene, c.here, 0, 1.0f);
    const PairedEvent there = event_at(c.scene, c.there, last, 0.6f);
    const auto alone = [&](const PairedEvent& e) {
        return [&](Rng& rng) {
            const ScatterEvent event{e.x, e.wo, 0.0f, e.phase};
            return e.weight * trace_after_event(context, event, rng).indirect;
        };
    };
    const MeanEstimate a = test::mean_of({}, 1, alone(here));
    const MeanEstimate b = test::mean_of({}, 2, alone(there));
    const MeanEstimate truth = combine(a, 1.0, b, -1.0);
    bool truncated = false;
    const MeanEstimate pairs = test::mean_of({}, 3, [&](Rng& rng) {
        return estimate_difference(context, here, there, 0.0f, c.params, rng, truncated);
    });
    const TestResult result = welch_test(pairs, truth);
    EXPECT_GT(result.p, alarm) << pairs.mean << " +- " << pairs.standard_error() << ", truly "
                               << truth.mean << " +- " << truth.standard_error();
}

INSTANTIATE_TEST_SUITE_P(Cases, PairedPathsStat, testing::ValuesIn(cases()),
                         [](const testing::TestParamInfo<PairCase>& c) {
                             return std::string(c.param.name);
                         });

TEST(PairedPaths, TheSameEventTwiceMakesNoDifference)
{
    const Scene scene = test::sun_and_sky().scene;
    PathTracerParams path;
    path.max_bounces = 8;
    const LightSampler lights(scene, path);
    const PairedEvent event = event_at(scene, Vec3(0.1f), 0, 1.0f);
    for (uint32_t i = 0; i < 200; ++i) {
        Rng rng(1, 0, Stream::Test, i, 0);
        bool truncated = false;
        const Spectrum difference =
            estimate_difference({scene, lights, path}, event, event, 0.0f, {0.1f}, rng, truncated);
        EXPECT_NEAR(luminance(difference), 0.0f, 1e-5f);
    }
}

TEST(PairedPaths, AnEventThatIsMissingLeavesTheOther)
{
    const Scene scene = test::sun_and_sky().scene;
    PathTracerParams path;
    path.max_bounces = 4;
    const LightSampler lights(scene, path);
    const TraceContext context{scene, lights, path};
    const PairedEvent event = event_at(scene, Vec3(0.1f), 0, 1.0f);
    bool truncated = false;
    const auto with = [&](const PairedEvent& a, const PairedEvent& b) {
        return test::mean_of({}, 5, [&](Rng& rng) {
            return estimate_difference(context, a, b, 0.0f, {0.2f}, rng, truncated);
        });
    };
    const MeanEstimate truth = test::mean_of({}, 6, [&](Rng& rng) {
        return event.weight *
               trace_after_event(context, {event.x, event.wo, 0.0f, event.phase}, rng).indirect;
    });
    EXPECT_GT(welch_test(with(event, {}), truth).p, alarm);
    const MeanEstimate minus = with({}, event);
    EXPECT_GT(welch_test(combine(minus, -1.0, truth, 0.0), truth).p, alarm);
    Rng rng(1, 0, Stream::Test, 0, 0);
    EXPECT_EQ(estimate_difference(context, {}, {}, 0.0f, {0.2f}, rng, truncated), Spectrum(0.0f));
}

/// The Jacobian against finite differences: the solid angle of a small triangle from two points.
TEST(PairedPaths, SolidAnglesFollowTheJacobian)
{
    const auto solid_angle = [](Vec3 from, const Vec3(&corner)[3]) {
        // Van Oosterom and Strackee 1983, in double.
        Vec3d r[3];
        for (int i = 0; i < 3; ++i) r[i] = glm::normalize(Vec3d(corner[i]) - Vec3d(from));
        const double volume = std::abs(glm::dot(r[0], glm::cross(r[1], r[2])));
        return 2.0 * std::atan2(volume, 1.0 + glm::dot(r[0], r[1]) + glm::dot(r[1], r[2]) +
                                            glm::dot(r[2], r[0]));
    };
    for (uint32_t i = 0; i < 100; ++i) {
        Rng rng(7, 0, Stream::Test, i, 0);
        const Vec3 a = rng.uniform3();
        const Vec3 b = rng.uniform3();
        const Vec3 y = rng.uniform3() + Vec3(1.5f, 0.0f, 0.0f);
        const Vec3 normal = glm::normalize(rng.uniform3() - Vec3(0.2f));
        const Vec3 u = 1e-3f * glm::normalize(glm::cross(normal, Vec3(0.3f, 0.5f, 0.7f)));
        const Vec3 v = glm::cross(normal, u);
        const Vec3 corner[3] = {y - u, y + u, y + v};
        const double expected = solid_angle(b, corner) / solid_angle(a, corner);
        const double found = static_cast<double>(solid_angle_ratio(a, b, y, &normal));
        EXPECT_NEAR(found / expected, 1.0, 0.02) << i;
    }
    const Vec3 y(0.0f, 0.0f, 1.0f);
    EXPECT_FLOAT_EQ(solid_angle_ratio({0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -1.0f}, y, nullptr), 0.25f);
    EXPECT_EQ(solid_angle_ratio({0.0f, 0.0f, 0.0f}, y, y, nullptr), 0.0f);
}

}  // namespace
}  // namespace mote
