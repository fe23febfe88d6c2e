#include <gtest/gtest.h>

#include "core/sampling.h"
#include "support/trials.h"
#include "volumes.h"
#include "volumes/collisions.h"

namespace mote {
namespace {

using test::along_x;
using test::bricks_of;
using test::bumpy_bricks;
using test::everything;
using test::expect_mean;
using test::marched_depth;
using test::run_trials;
using test::slab;
using test::unit_cube;
using test::volume_of;

TEST(TrackingStat, SlabTransmittanceFromThinToOpaque)
{
    for (const float tau : {1e-3f, 0.1f, 1.0f, 8.0f}) {
        const Media media{{slab(tau)}};
        // Slanted, so that the edges' ramps take part.
        const Ray ray{{-1.0f, 0.3f, 0.2f}, glm::normalize(Vec3(1.0f, 0.2f, 0.13f))};
        const double exact = std::exp(-static_cast<double>(optical_depth(media, ray, everything)));
        const RunningStats delta = run_trials(200'000, 1, [&](Rng& rng) {
            return sample_free_flight(media, ray, everything, rng) ? 0.0f : 1.0f;
        });
        const RunningStats ratio = run_trials(100'000, 2, [&](Rng& rng) {
            return estimate_transmittance(media, ray, everything, TransmittanceKind::Ratio, rng);
        });
        expect_mean(delta, exact, "delta");
        expect_mean(ratio, exact, "ratio");
    }
}

TEST(TrackingStat, DeltaRatioResidualAndExactAgreeInAHeterogeneousMedium)
{
    for (const MovingTransform& transform : {MovingTransform{}, test::tilted()}) {
        const Media media{{volume_of(bumpy_bricks(), 6.0f, transform)}};
        const Bounds3 bounds = world_bounds(media.volumes[0]);
        int checked = 0;
        for (uint32_t i = 0; checked < 6; ++i) {
            const Ray ray = test::test_ray(bounds, i);
            const double depth = static_cast<double>(optical_depth(media, ray, everything));
            if (depth < 0.1) continue;
            ++checked;
            const double exact = std::exp(-depth);
            Rng unused(0, 0, Stream::Test, 0, 0);
            EXPECT_NEAR(static_cast<double>(estimate_transmittance(
                            media, ray, everything, TransmittanceKind::Exact, unused)),
                        exact, 1e-6);
            expect_mean(
                run_trials(60'000, 10 + i,
                           [&](Rng& rng) {
                               return sample_free_flight(media, ray, everything, rng) ? 0.0f : 1.0f;
                           }),
                exact, "delta");
            for (const auto kind : {TransmittanceKind::Ratio, TransmittanceKind::ResidualRatio}) {
                expect_mean(run_trials(60'000, 20 + i,
                                       [&](Rng& rng) {
                                           return estimate_transmittance(media, ray, everything,
                                                                         kind, rng);
                                       }),
                            exact, "ratio family");
            }
        }
    }
}

TEST(TrackingStat, FreeFlightsFollowTheOpticalDepth)
{
    // tau(t_collision), cut at the whole depth, is a truncated exponential: compare its mean, which
    // sees the place of every collision and not only whether there is one.
    const Media media{{volume_of(bumpy_bricks(), 9.0f, test::tilted())}};
    const Vec3 middle = world_bounds(media.volumes[0]).centre();
    const Vec3 d = glm::normalize(Vec3(0.15f, 1.0f, 0.1f));
    const Ray ray{middle - 2.0f * d, d};
    const double depth = static_cast<double>(optical_depth(media, ray, everything));
    ASSERT_GT(depth, 1.0);
    const double exact = 1.0 - std::exp(-depth);
    const auto spent = [&](const std::optional<Collision>& hit) {
        return hit ? static_cast<double>(optical_depth(media, ray, {0.0f, hit->t})) : depth;
    };
    expect_mean(run_trials(60'000, 31,
                           [&](Rng& rng) {
                               return spent(sample_free_flight(media, ray, everything, rng));
                           }),
                exact, "delta tracking");
    expect_mean(
        run_trials(60'000, 32,
                   [&](Rng& rng) {
                       return spent(invert_optical_depth(media.volumes[0], ray, everything,
                                                         sample_exponential(rng.uniform())));
                   }),
        exact, "inversion");
}

TEST(TrackingStat, OverlappingMediaAddUp)
{
    const Media media{{volume_of(bumpy_bricks(), 2.0f, test::tilted()), slab(1.5f),
                       volume_of(bumpy_bricks(), 3.0f)}};
    const Vec3 middle = world_bounds(media.volumes[0]).centre();
    const Vec3 d = glm::normalize(Vec3(0.5f) - middle);  // through the middle of all three
    const Ray ray{middle - 1.0f * d, d};
    double sum = 0.0;
    for (const Volume& volume : media.volumes) {
        sum += static_cast<double>(optical_depth(volume, ray, everything));
    }
    ASSERT_GT(sum, 2.0);
    EXPECT_NEAR(static_cast<double>(optical_depth(media, ray, everything)), sum, 1e-5);
    RunningStats hits[3];
    const RunningStats escaped = run_trials(100'000, 41, [&](Rng& rng) {
        const auto hit = sample_free_flight(media, ray, everything, rng);
        for (int i = 0; i < 3; ++i) hits[i].add(hit && hit->volume == i ? 1.0 : 0.0);
        return hit ? 0.0f : 1.0f;
    });
    expect_mean(escaped, std::exp(-sum), "escape");
    // Volume i is hit with probability integral sigma_i T dt: midpoints along the ray.
    for (int i = 0; i < 3; ++i) {
        const Volume& volume = media.volumes[static_cast<size_t>(i)];
        const Mat4d object_from_world = glm::inverse(matrix(volume.world_from_object.at(0.0f)));
        double exact = 0.0;
        for (int k = 0; k < 4000; ++k) {
            const float t = 3.0f * (static_cast<float>(k) + 0.5f) / 4000.0f;
            const Vec3 p(object_from_world * glm::dvec4(Vec3d(ray.at(t)), 1.0));
            exact += static_cast<double>(sigma_t_at(volume, p)) * (3.0 / 4000.0) *
                     std::exp(-static_cast<double>(optical_depth(media, ray, {0.0f, t})));
        }
        expect_mean(hits[i], exact, "share of one volume");
    }
}

TEST(TrackingStat, CameraInsideTheMedium)
{
    const Media media{{volume_of(bumpy_bricks(), 10.0f)}};
    const Ray ray{{0.5f, 0.5f, 0.5f}, glm::normalize(Vec3(0.3f, -0.8f, 0.5f))};
    const double depth = static_cast<double>(optical_depth(media, ray, everything));
    ASSERT_GT(depth, 0.5);
    EXPECT_NEAR(depth, marched_depth(media.volumes[0], ray, {0.0f, 1.5f}, 20000), 2e-4 * depth);
    expect_mean(run_trials(60'000, 51,
                           [&](Rng& rng) {
                               return sample_free_flight(media, ray, everything, rng) ? 0.0f : 1.0f;
                           }),
                std::exp(-depth), "delta");
}

TEST(TrackingStat, MovingVolumesAreSeenAtTheRaysTime)
{
    Trs open;
    Trs close;
    close.translate = Vec3d(0.0, 2.0, 0.0);
    const Volume volume = volume_of(slab(3.0f).density, 3.0f, {{open, close}});
    Ray ray = along_x;
    EXPECT_NEAR(optical_depth(volume, ray, everything), 3.0f, 1e-5f);
    ray.time = 1.0f;
    EXPECT_EQ(optical_depth(volume, ray, everything), 0.0f);
    ray.o.y += 2.0f;
    EXPECT_NEAR(optical_depth(volume, ray, everything), 3.0f, 1e-5f);
    const Bounds3 bounds = world_bounds(volume);
    EXPECT_LT(bounds.lo.y, 0.0f);
    EXPECT_GT(bounds.hi.y, 3.0f);
}

TEST(TrackingStat, NegativeControlATooLowMajorantIsFound)
{
    // The same walk with a majorant 20 % below the maximum: the comparison above must reject it.
    const Volume volume = volume_of(bumpy_bricks(), 6.0f);
    const BrickGrid& grid = *volume.density;
    const Ray ray{{-1.0f, 0.52f, 0.4f}, {1.0f, 0.0f, 0.0f}};
    const LocalRay local = make_local_ray(grid, frames_at(volume, 0.0f).density, ray, everything);
    const double exact = std::exp(-static_cast<double>(optical_depth(volume, ray, everything)));
    const RunningStats wrong = run_trials(60'000, 61, [&](Rng& rng) {
        return for_each_collision(
                   grid, local, volume.density_scale, rng,
                   [](const BrickRange& range, const BrickSpan&) { return 0.8f * range.max; },
                   [&](float s, const BrickSpan& span, float majorant) {
                       return rng.uniform() * majorant >= sample_in_brick(grid, span, local.at(s));
                   })
                   ? 1.0f
                   : 0.0f;
    });
    EXPECT_GT(std::abs(wrong.mean - exact), 5.0 * wrong.standard_error());
}

TEST(Tracking, ScaleInvariance)
{
    // Lengths times s, extinction over s: the same optical depth, the same random decisions.
    const Media base{{volume_of(bumpy_bricks(), 8.0f, test::tilted())}};
    for (const double s : {1e-3, 1e3}) {
        const float f = static_cast<float>(s);
        const Media scaled{{volume_of(bumpy_bricks(), 8.0f / f, test::tilted(s))}};
        int same = 0;
        for (uint32_t i = 0; i < 500; ++i) {
            const Ray ray = test::test_ray(world_bounds(base.volumes[0]), i);
            const Ray big{ray.o * f, ray.d, ray.time};
            const float tau = optical_depth(base, ray, everything);
            EXPECT_NEAR(optical_depth(scaled, big, everything), tau, 2e-5f * tau + 1e-5f);
            Rng a(5, 0, Stream::Test, i, 0);
            Rng b(5, 0, Stream::Test, i, 0);
            const auto hit = sample_free_flight(base, ray, everything, a);
            const auto hit_big = sample_free_flight(scaled, big, everything, b);
            if (hit.has_value() != hit_big.has_value()) continue;
            if (hit && std::abs(hit_big->t / f - hit->t) > 1e-4f * hit->t) continue;
            ++same;
        }
        EXPECT_GE(same, 498);  // rounding may flip a decision once in thousands
    }
}

TEST(Tracking, EmptyVolumesAndZeroDensityAreTransparent)
{
    const auto nothing = bricks_of({8, 8, 8}, unit_cube(), [](Vec3i) { return 0.0f; });
    Volume zero = volume_of(bumpy_bricks(), 0.0f);
    Volume none;
    finalize(none);
    const Media media{{volume_of(nothing, 1.0f), zero, none}};
    Rng rng(1, 0, Stream::Test, 0, 0);
    EXPECT_FALSE(sample_free_flight(media, along_x, everything, rng));
    EXPECT_EQ(optical_depth(media, along_x, everything), 0.0f);
    for (const auto kind :
         {TransmittanceKind::Ratio, TransmittanceKind::ResidualRatio, TransmittanceKind::Exact}) {
        EXPECT_EQ(estimate_transmittance(media, along_x, everything, kind, rng), 1.0f);
    }
    EXPECT_TRUE(world_bounds(none).is_empty());
}

}  // namespace
}  // namespace mote
