#include <gtest/gtest.h>

#include <functional>

#include "reference/path_tracer.h"
#include "restir/candidates.h"
#include "restir/direction_hits.h"
#include "restir/mixed_phase.h"
#include "restir/runs.h"
#include "support/trials.h"
#include "volumes/media_at.h"

// What must not pass: deliberately wrong estimators that the statistics of the other tests have to
// reject.

namespace mote {
namespace {

using test::TestScene;

/// p of the image of `wrong` against the path tracer's of `right`.
double p_of(const TestScene& right, const TestScene& wrong, const RestirParams& params = {})
{
    const test::Effort effort{32, 6, 128};
    RenderDescription render = test::description(wrong, EstimatorKind::Restir, effort.samples);
    render.restir = params;
    render.restir.reuse = ReuseMode::Off;
    return compare_runs(test::render_runs(wrong, render, effort.runs, 1),
                        test::reference_runs(right, effort))
        .p;
}

TEST(NegativeControlStat, WrongScenesAreRejected)
{
    const TestScene right = test::sun_and_sky();
    EXPECT_GT(p_of(right, right), test::alarm);

    TestScene wrong = right;
    Volume* volume = wrong.scene.media.volumes.data();
    volume->albedo = Spectrum(1.0f);
    EXPECT_LT(p_of(right, wrong), test::alarm) << "albedo left out";

    wrong = right;
    volume = wrong.scene.media.volumes.data();
    volume->world_from_object.keys[0].translate += Vec3d(0.5 * 2.0 / 23.0, 0.0, 0.0);
    finalize(*volume);
    EXPECT_LT(p_of(right, wrong), test::alarm) << "half a voxel to the side";

    wrong = right;
    volume = wrong.scene.media.volumes.data();
    volume->phase.g = 0.0f;
    EXPECT_LT(p_of(right, wrong), test::alarm) << "phase function left out";

    wrong = right;
    std::get<DistantLight>(wrong.scene.lights[0]).irradiance *= 1.05f;
    wrong.scene.environment->radiance *= 1.05f;
    EXPECT_LT(p_of(right, wrong), test::alarm) << "phase function normalised to 1.05";
}

TEST(NegativeControlStat, ClosedFormsWithoutCorrectionsAreRejected)
{
    // The caches know little of a thin shaft of light between two dense bodies.
    TestScene test = test::sun_and_sky(60.0f);
    RestirParams params;
    params.corrections = false;
    EXPECT_LT(p_of(test, test, params), test::alarm);
}

/// What a candidate brings, given the transmittance of its shadow ray and of the one before it.
using Contribution = std::function<Spectrum(const FrameDomain&, const PixelDomain&,
                                            const Candidate&, float T, float T_before)>;

/// Luminance over random rays of the camera.
RunningStats estimate(const FrameDomain& frame, uint32_t count, const Contribution& contribution)
{
    std::vector<Candidate> candidates;
    float T_before = 1.0f;
    return test::run_trials(count, 31, [&](Rng& rng) {
        PixelDomain domain;
        BinCounts counts;
        make_pixel_domain(frame, test::random_ray(frame.scene->camera, rng), domain, counts);
        if (domain.bins.empty()) return 0.0f;
        weigh_bins(frame, domain);
        candidates.clear();
        draw_candidates(frame, domain, 4, rng, candidates);
        Spectrum sum(0.0f);
        for (const Candidate& c : candidates) {
            const Ray ray{c.x, c.arrival.wi, domain.ray.time};
            const float T =
                std::exp(-optical_depth(frame.scene->media, ray, {0.0f, c.arrival.distance}));
            sum += contribution(frame, domain, c, T, T_before);
            T_before = T;
        }
        return luminance(sum);
    });
}

/// The same by the path tracer.
RunningStats reference(const Scene& scene, uint32_t count)
{
    PathTracerParams params;
    params.transmittance = TransmittanceKind::Exact;
    params.equiangular = true;
    const LightSampler lights(scene, params);
    return test::run_trials(count, 32, [&](Rng& rng) {
        const Ray ray = test::random_ray(scene.camera, rng);
        return luminance(trace_path(scene, lights, params, ray, rng).direct);
    });
}

double z_of(const RunningStats& a, const RunningStats& b)
{
    return std::abs(a.mean - b.mean) / std::sqrt(a.variance_of_mean() + b.variance_of_mean());
}

Spectrum right(const FrameDomain& /*frame*/, const PixelDomain& /*domain*/, const Candidate& c,
               float T, float /*T_before*/)
{
    return T * c.f / c.density;
}

Spectrum shadow_of_another(const FrameDomain& /*frame*/, const PixelDomain& /*domain*/,
                           const Candidate& c, float /*T*/, float T_before)
{
    return T_before * c.f / c.density;
}

Spectrum without_albedo(const FrameDomain& frame, const PixelDomain& domain, const Candidate& c,
                        float T, float /*T_before*/)
{
    const Spectrum scattering =
        scattering_at(frame, c.x, domain.ray.time, domain.wo(), c.arrival.wi);
    Spectrum phase(0.0f);
    for_each_scatterer(frame.scene->media, c.x, domain.ray.time,
                       [&](const Volume& volume, float share, Spectrum) {
                           phase += share * eval_phase(volume.phase, domain.wo(), c.arrival.wi);
                       });
    return T * c.f * (phase / glm::max(scattering, Spectrum(1e-20f))) / c.density;
}

Spectrum without_mis(const FrameDomain& frame, const PixelDomain& domain, const Candidate& c,
                     float T, float /*T_before*/)
{
    const float time = domain.ray.time;
    const float pdf_dir =
        mixed_phase_at(frame.scene->media, c.x, time).pdf(domain.wo(), c.arrival.wi);
    const float phase_density =
        4.0f * pdf_dir * density_per_direction(frame, frame.phase_finds, c.x, time, c.y, c.arrival);
    return T * c.f / std::max(c.density - phase_density, 1e-3f * c.density);
}

struct Control {
    TestScene test;
    uint32_t count;  ///< rays
    std::vector<Contribution> wrong;
};

TEST(NegativeControlStat, WrongContributionsAreRejected)
{
    // 5 combined standard errors: a false alarm in 1.7 million seeds for each of the right ones.
    const std::vector<Control> controls{
        {test::overlapping(), 8000, {without_albedo, without_mis}},
        {test::quads(), 8000, {without_albedo, without_mis, shadow_of_another}},
        {test::flame_in_smoke(), 30'000, {without_albedo, without_mis}},
    };
    for (const Control& control : controls) {
        SCOPED_TRACE(control.test.name);
        const FrameDomain frame = test::candidates_domain(control.test.scene);
        const RunningStats truth = reference(control.test.scene, 150'000);
        EXPECT_LT(z_of(estimate(frame, control.count, right), truth), 5.0);
        for (const Contribution& wrong : control.wrong) {
            EXPECT_GT(z_of(estimate(frame, control.count, wrong), truth), 5.0);
        }
    }
}

}  // namespace
}  // namespace mote
