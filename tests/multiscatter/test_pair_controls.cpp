// Wrong ways to lead two paths to one place must be found out, with the same effort and the same
// test by which the right one passes.

#include <gtest/gtest.h>

#include "multiscatter/batches.h"
#include "multiscatter/paired_paths.h"
#include "restir/scenes.h"

namespace mote {
namespace {

constexpr double alarm = 1e-5;

enum class Mistake { None, NoJacobian, NoShadow, NoPhase, KeepsWeightAfterFailure };

/// Light of two events, by pairs that are led to the second one: the estimator in its simplest
/// form, open to mistakes.
struct SimplePair {
    const TraceContext& context;
    Mistake mistake = Mistake::None;
    float farthest = 0.4f;  ///< [m]

    Spectrum operator()(const PairedEvent& here, const PairedEvent& there, Rng& rng) const
    {
        const Media& media = context.scene.media;
        const bool swaps = rng.uniform() < 0.5f;
        const PairedEvent& own = swaps ? there : here;
        const PairedEvent& other = swaps ? here : there;
        const Vec3 wi = sample_phase(*own.phase, own.wo, rng.uniform2());
        const Ray ray{own.x, wi, 0.0f};
        const auto hit = sample_free_flight(media, ray, {0.0f, infinity}, rng);
        if (!hit) return Spectrum(0.0f);
        const Vec3 y = ray.at(hit->t);
        const Vec3 to_y = y - other.x;
        const float length = glm::length(to_y);
        const Ray other_ray{other.x, to_y / length, 0.0f};
        float ratio = 1.0f;
        if (mistake != Mistake::NoPhase) {
            ratio *=
                phase_pdf(*other.phase, other.wo, other_ray.d) / phase_pdf(*own.phase, own.wo, wi);
        }
        if (mistake != Mistake::NoJacobian) {
            ratio *= solid_angle_ratio(own.x, other.x, y, nullptr);
        }
        if (mistake != Mistake::NoShadow) {
            ratio *= std::exp(optical_depth(media, ray, {0.0f, hit->t}) -
                              optical_depth(media, other_ray, {0.0f, length}));
        }
        // Pairs that are led too far count as failed: then own's path stands alone.
        const bool fails = length > farthest || hit->t > farthest;
        if (fails) ratio = 0.0f;
        float own_weight = 2.0f / (1.0f + ratio);
        if (fails && mistake == Mistake::KeepsWeightAfterFailure) own_weight = 1.0f;
        const Phase& phase = media.volumes[0].phase;
        const Spectrum albedo = albedo_at(media.volumes[0], hit->p_object);
        const auto lit = [&](Vec3 wo) {
            return estimate_direct_light(context, {y, wo, 0.0f, &phase}, rng);
        };
        Spectrum sum = own_weight * own.weight * lit(-wi);
        if (ratio > 0.0f) sum -= ratio * own_weight * other.weight * lit(-other_ray.d);
        return (swaps ? -1.0f : 1.0f) * albedo * sum;
    }
};

TestResult judge(Mistake mistake, float density = 6.0f, float farthest = 0.4f,
                 Vec3 second = Vec3(0.25f, -0.1f, 0.1f))
{
    Scene scene = test::sun_and_sky(density).scene;
    scene.environment.reset();
    PathTracerParams path;
    path.max_bounces = 2;
    const LightSampler lights(scene, path);
    const TraceContext context{scene, lights, path};
    const auto event_at = [&](Vec3 x) {
        return PairedEvent{x, glm::normalize(Vec3(0.5f, 0.4f, 3.2f) - x),
                           &scene.media.volumes[0].phase, Spectrum(0.8f)};
    };
    const PairedEvent here = event_at(Vec3(0.1f, 0.05f, 0.2f));
    const PairedEvent there = event_at(second);
    const test::Batches batches{32, 5000};
    const auto alone = [&](const PairedEvent& e) {
        return [&](Rng& rng) {
            return e.weight * trace_after_event(context, {e.x, e.wo, 0.0f, e.phase}, rng).indirect;
        };
    };
    const MeanEstimate a = test::mean_of(batches, 1, alone(here));
    const MeanEstimate b = test::mean_of(batches, 2, alone(there));
    const SimplePair pair{context, mistake, farthest};
    const MeanEstimate found =
        test::mean_of(batches, 3, [&](Rng& rng) { return pair(here, there, rng); });
    return welch_test(found, combine(a, 1.0, b, -1.0));
}

TEST(PairControlsStat, TheRightWeightsPass)
{
    EXPECT_GT(judge(Mistake::None).p, alarm);
    EXPECT_GT(judge(Mistake::None, 12.0f, 1.0f, Vec3(0.1f, 0.5f, 0.4f)).p, alarm);
}

TEST(PairControlsStat, AMissingJacobianIsFoundOut)
{
    EXPECT_LT(judge(Mistake::NoJacobian).p, alarm);
}

TEST(PairControlsStat, TheOtherEventsShadowMustBeAsked)
{
    EXPECT_LT(judge(Mistake::NoShadow, 12.0f, 1.0f, Vec3(0.1f, 0.5f, 0.4f)).p, alarm);
}

TEST(PairControlsStat, ThePhaseFunctionIsTheOtherEvents)
{
    EXPECT_LT(judge(Mistake::NoPhase).p, alarm);
}

TEST(PairControlsStat, AFailedPairCountsOnceMore)
{
    EXPECT_LT(judge(Mistake::KeepsWeightAfterFailure, 6.0f, 0.25f).p, alarm);
}

}  // namespace
}  // namespace mote
