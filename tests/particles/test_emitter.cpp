#include "particles/emitter.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "core/rng.h"
#include "particles/curl_noise.h"
#include "support/expect_error.h"

namespace mote {
namespace {

constexpr EmitterKind all_kinds[] = {EmitterKind::Plume, EmitterKind::Burst, EmitterKind::Disk,
                                     EmitterKind::Snow};

EmitterParams emitter(EmitterKind kind, int64_t count = 5000)
{
    EmitterParams params;
    params.kind = kind;
    params.count = count;
    params.position = Vec3(0.5f, -1.0f, 2.0f);
    params.gravity = kind == EmitterKind::Burst ? 2.0f : 0.0f;
    params.cooling = 0.5f;
    params.temperature = 900.0f;
    params.radius_growth = 0.01f;
    return params;
}

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b)
{
    if (a.size() != b.size()) return false;
    return a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

bool same_bits(const ParticleSet& a, const ParticleSet& b)
{
    return same_bits(a.position, b.position) && same_bits(a.velocity, b.velocity) &&
           same_bits(a.radius, b.radius) && same_bits(a.mass, b.mass) &&
           same_bits(a.temperature, b.temperature) && same_bits(a.color, b.color) &&
           same_bits(a.id, b.id) && same_bits(a.age, b.age);
}

std::map<int64_t, size_t> index_by_id(const ParticleSet& set)
{
    std::map<int64_t, size_t> index;
    for (size_t i = 0; i < set.size(); ++i) index[set.id[i]] = i;
    return index;
}

double total_mass(const ParticleSet& set)
{
    double sum = 0.0;
    for (const float m : set.mass) sum += double{m};
    return sum;
}

TEST(Emitter, AFrameDoesNotDependOnTheFramesBefore)
{
    for (const EmitterKind kind : all_kinds) {
        const EmitterParams params = emitter(kind);
        const ParticleSet alone = emit_particles(params, 40.0 / 24.0);
        for (int frame = 1; frame < 40; ++frame) (void)emit_particles(params, frame / 24.0);
        EXPECT_TRUE(same_bits(alone, emit_particles(params, 40.0 / 24.0)));
        EXPECT_FALSE(same_bits(alone, emit_particles(params, 39.0 / 24.0)));
    }
}

TEST(Emitter, SameBitsForAnyThreadCount)
{
    for (const EmitterKind kind : all_kinds) {
        const EmitterParams params = emitter(kind, 30'001);
        const ParticleSet set = emit_particles(params, 5.0);
        for (const int threads : {1, 2, 3, 8}) {
            run_with_threads(threads, [&] {
                EXPECT_TRUE(same_bits(set, emit_particles(params, 5.0))) << threads;
            });
        }
    }
}

TEST(Emitter, AFullFrameHoldsExactlyTheCount)
{
    for (const EmitterKind kind : all_kinds) {
        for (const int64_t count : {1, 2, 15, 17, 1000, 5003}) {
            const EmitterParams params = emitter(kind, count);
            const double time = kind == EmitterKind::Burst ? 1.3 : 7.3;
            const ParticleSet set = emit_particles(params, time);
            ASSERT_EQ(set.size(), static_cast<size_t>(count));
            EXPECT_EQ(index_by_id(set).size(), set.size());  // ids are unique
            for (size_t i = 0; i < set.size(); ++i) {
                EXPECT_TRUE(is_finite(set.position[i]) && is_finite(set.velocity[i]));
                EXPECT_GE(set.age[i], 0.0f);
                EXPECT_GE(set.mass[i], 0.0f);
                EXPECT_GE(set.radius[i], params.radius);
                EXPECT_TRUE(kind == EmitterKind::Snow || set.age[i] <= params.lifetime);
            }
        }
    }
}

/// Nothing flies, and no age or place is lost in a division by a speed.
TEST(Emitter, NoSpeedIsNoReasonToBeNowhere)
{
    for (const EmitterKind kind : all_kinds) {
        for (const float turbulence : {0.0f, 0.5f}) {
            EmitterParams params = emitter(kind, 500);
            params.speed = 0.0f;
            params.turbulence = turbulence;
            const ParticleSet set = emit_particles(params, 1.3);
            ASSERT_GT(set.size(), 0u);
            for (size_t i = 0; i < set.size(); ++i) {
                EXPECT_TRUE(is_finite(set.position[i]) && is_finite(set.velocity[i]));
                EXPECT_TRUE(std::isfinite(set.age[i]) && std::isfinite(set.radius[i]));
            }
        }
    }
}

TEST(Emitter, PlumeFillsOverALifetimeAndIdsRise)
{
    const EmitterParams params = emitter(EmitterKind::Plume, 1000);  // 250 births a second
    EXPECT_EQ(emit_particles(params, -0.1).size(), 0u);
    EXPECT_EQ(emit_particles(params, 1.0).size(), 251u);
    const ParticleSet later = emit_particles(params, 100.0);
    EXPECT_EQ(later.id.back(), 25'000);
    EXPECT_EQ(later.id.front(), 24'001);
    EXPECT_EQ(emit_particles(emitter(EmitterKind::Burst), 4.0).size(), 0u);  // all dead
}

// Particles are found again by id; positions at t +- h must agree with velocities. Paths are smooth
// inside an integration step (error h^2 x'''/6, below 1e-3 m/s; rounding, which turbulence
// amplifies by up to e^6: 3e-5 m / 2h = 4e-3 m/s) and velocities jump slightly between steps, which
// 2h / dt = 5 % of the particles straddle: hence the median and the 90th percentile.
TEST(Emitter, VelocityIsTheDerivativeOfPosition)
{
    constexpr double h = 4e-3;
    for (const EmitterKind kind : all_kinds) {
        const EmitterParams params = emitter(kind);
        constexpr double time = 2.217;
        const ParticleSet before = emit_particles(params, time - h);
        const ParticleSet set = emit_particles(params, time);
        const ParticleSet after = emit_particles(params, time + h);
        const auto in_before = index_by_id(before);
        const auto in_after = index_by_id(after);
        std::vector<float> errors;
        for (size_t i = 0; i < set.size(); ++i) {
            const auto a = in_before.find(set.id[i]);
            const auto b = in_after.find(set.id[i]);
            if (a == in_before.end() || b == in_after.end()) continue;
            const Vec3 moved = after.position[b->second] - before.position[a->second];
            errors.push_back(glm::length(moved / static_cast<float>(2.0 * h) - set.velocity[i]));
        }
        ASSERT_GT(errors.size(), set.size() * 9 / 10);
        std::sort(errors.begin(), errors.end());
        EXPECT_LT(errors[errors.size() / 2], 5e-3f) << static_cast<int>(kind);
        EXPECT_LT(errors[errors.size() * 9 / 10], 0.03f) << static_cast<int>(kind);
        const float speed = glm::length(set.velocity[set.size() / 2]);
        EXPECT_GT(speed, 0.1f);  // the errors are small beside the velocities
    }
}

// Steady emitters: the masses of a full frame add up to `mass`. The particles sample the fade
// curve at even steps of life, so the sum is off by about 1/count; snow samples it at random ages
// (variance of the fade below 0.06 per particle: 4 standard errors are 4 sqrt(0.06/5000) = 1.4 %).
TEST(Emitter, SteadyMassIsTheGivenMass)
{
    for (const EmitterKind kind : {EmitterKind::Plume, EmitterKind::Disk, EmitterKind::Snow}) {
        EmitterParams params = emitter(kind);
        params.mass = 3.0f;
        const double tolerance = kind == EmitterKind::Snow ? 0.014 : 0.001;
        for (const double time : {4.5, 5.0, 17.77}) {
            EXPECT_NEAR(total_mass(emit_particles(params, time)) / 3.0, 1.0, tolerance);
        }
    }
    EXPECT_NEAR(total_mass(emit_particles(emitter(EmitterKind::Burst), 1.0)), 1.0, 1e-4);
}

TEST(Emitter, MassFadesSmoothlyAtBirthAndDeath)
{
    for (const EmitterKind kind : all_kinds) {
        const EmitterParams params = emitter(kind);
        double previous = total_mass(emit_particles(params, 0.0));
        for (int frame = 1; frame <= 24 * 5; ++frame) {
            const double now = total_mass(emit_particles(params, frame / 24.0));
            // The burst fades in over 2 % of 4 s, two frames; out over 40 %.
            EXPECT_LT(std::abs(now - previous), frame <= 3 ? 0.8 : 0.05) << frame;
            previous = now;
        }
        // Nobody appears or vanishes with mass: single particles at the ends of life weigh little.
        const float full = 1.0f / static_cast<float>(params.count);
        const ParticleSet set = emit_particles(params, 3.0);
        for (size_t i = 0; i < set.size() && kind == EmitterKind::Plume; ++i) {
            EXPECT_TRUE(set.age[i] >= 0.01f || set.mass[i] < 0.02f * full);
        }
    }
}

TEST(Emitter, BurstFollowsTheExactDragSolution)
{
    EmitterParams params = emitter(EmitterKind::Burst, 200);
    params.turbulence = 0.0f;
    params.drag = 1.7f;
    params.gravity = 9.81f;
    const ParticleSet start = emit_particles(params, 0.0);
    const double t = 1.25;
    const ParticleSet set = emit_particles(params, t);
    const double decay = std::exp(-1.7 * t);
    const double reach = (1.0 - decay) / 1.7;
    const double fall = -9.81 * (t - reach) / 1.7;
    for (size_t i = 0; i < set.size(); ++i) {
        const Vec3d expected =
            Vec3d(start.position[i]) + Vec3d(start.velocity[i]) * reach + Vec3d(0.0, fall, 0.0);
        EXPECT_LT(glm::length(expected - Vec3d(set.position[i])), 2e-6);  // a few float roundings
    }
    params.drag = 0.0f;  // the limit: free fall
    const ParticleSet free = emit_particles(params, t);
    const Vec3d expected = Vec3d(start.position[0]) + Vec3d(start.velocity[0]) * t -
                           Vec3d(0.0, 0.5 * 9.81 * t * t, 0.0);
    EXPECT_LT(glm::length(expected - Vec3d(free.position[0])), 2e-6);
}

TEST(Emitter, SnowStaysInItsBoxAndTheDiskTurns)
{
    EmitterParams snow = emitter(EmitterKind::Snow);
    snow.turbulence = 0.0f;
    snow.size = 2.0f;
    for (const Vec3& p : emit_particles(snow, 12.3).position) {
        EXPECT_LE(std::abs(p.y + 1.0f), 2.0f + 1e-5f);
    }
    const ParticleSet disk = emit_particles(emitter(EmitterKind::Disk), 3.0);
    double turning = 0.0;
    for (size_t i = 0; i < disk.size(); ++i) {
        const Vec3 r = disk.position[i] - Vec3(0.5f, -1.0f, 2.0f);
        turning += double{r.x * disk.velocity[i].z - r.z * disk.velocity[i].x} > 0.0 ? 1.0 : 0.0;
    }
    EXPECT_GT(turning, 0.9 * static_cast<double>(disk.size()));
}

TEST(Emitter, OnlyMaskedAttributesAreFilled)
{
    const AttributeMask none{false, false, false, false, false};
    const ParticleSet set = emit_particles(emitter(EmitterKind::Plume), 2.0, none);
    EXPECT_GT(set.size(), 0u);
    EXPECT_EQ(set.radius.size(), set.size());
    EXPECT_EQ(set.mass.size(), set.size());
    EXPECT_TRUE(set.velocity.empty() && set.temperature.empty() && set.color.empty() &&
                set.id.empty() && set.age.empty());
    const ParticleSet full = emit_particles(emitter(EmitterKind::Plume), 2.0);
    EXPECT_TRUE(same_bits(set.position, full.position));
    for (size_t i = 0; i < full.size(); ++i) {
        EXPECT_NEAR(full.temperature[i], 300.0 + 600.0 * std::exp(-0.5 * double{full.age[i]}),
                    1e-3);
    }
}

TEST(Emitter, WrongParametersAreNamed)
{
    const auto message = [](auto change) {
        EmitterParams params;
        change(params);
        return error_message([&] { (void)emit_particles(params, 1.0); });
    };
    EXPECT_EQ(message([](EmitterParams& p) { p.count = 0; }),
              "emitter: count must be in [1, 100000000]");
    EXPECT_EQ(message([](EmitterParams& p) { p.lifetime = 0.0f; }),
              "emitter: lifetime must be above 0");
    EXPECT_EQ(message([](EmitterParams& p) { p.size = infinity; }),
              "emitter: size must be above 0");
    EXPECT_EQ(message([](EmitterParams& p) { p.spread = 90.0f; }),
              "emitter: spread must be in [0, 80] degrees");
    EXPECT_EQ(message([](EmitterParams& p) { p.radius = -1.0f; }),
              "emitter: radius must be above 0");
}

Vec3 curl_at(const CurlNoise& noise, Vec3 p, float t = 0.0f)
{
    Lanes3 at;
    Lanes time;
    Lanes3 u;
    at.x[0] = p.x;
    at.y[0] = p.y;
    at.z[0] = p.z;
    time[0] = t;
    eval_curl_noise(noise, at, time, u);
    return {u.x[0], u.y[0], u.z[0]};
}

// Central differences over 2h with h = 1e-3 of an eddy 0.5 m wide: error terms are h^2 k^3 u / 6
// (below 3e-3 / s) and float rounding 1e-6 / 2h = 5e-4; single derivatives are near 20 / s.
TEST(CurlNoise, HasNoDivergenceAndTheGivenSpeed)
{
    const CurlNoise noise = make_curl_noise({0.5f, 0.7f, Vec3(0.0f, 1.0f, 0.0f), 3}, 123.4);
    Rng rng(1, 0, Stream::Test, 0, 0);
    constexpr float h = 1e-3f;
    double square = 0.0;
    double gradient = 0.0;
    constexpr int trials = 4000;
    for (int i = 0; i < trials; ++i) {
        const Vec3 p = 8.0f * (rng.uniform3() - 0.5f);
        float divergence = 0.0f;
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 step(0.0f);
            step[axis] = h;
            const Vec3 slope = (curl_at(noise, p + step) - curl_at(noise, p - step)) / (2.0f * h);
            divergence += slope[axis];
            gradient += double{sqr(slope[axis])} / (3.0 * trials);
        }
        EXPECT_LT(std::abs(divergence), 0.02f);
        const Vec3 u = curl_at(noise, p);
        square += double{glm::dot(u, u)} / trials;
    }
    EXPECT_GT(std::sqrt(gradient), 1.0);  // negative control: single derivatives do not vanish
    EXPECT_NEAR(std::sqrt(square) / 0.7, 1.0, 0.05);
}

TEST(CurlNoise, RateIsTheDerivativeAlongTheMotion)
{
    const CurlNoiseParams params{0.5f, 0.7f, Vec3(0.3f, 1.0f, 0.0f), 3};
    const CurlNoise noise = make_curl_noise(params, 50.0);
    Rng rng(2, 0, Stream::Test, 0, 0);
    constexpr float h = 1e-3f;
    for (int i = 0; i < 500; ++i) {
        const Vec3 p = 4.0f * (rng.uniform3() - 0.5f);
        const Vec3 motion = rng.uniform3() - 0.5f;
        Lanes3 at;
        Lanes3 along;
        Lanes3 u;
        Lanes3 rate;
        for (size_t axis = 0; axis < 3; ++axis) {
            (&at.x)[axis][5] = p[static_cast<int>(axis)];
            (&along.x)[axis][5] = motion[static_cast<int>(axis)];
        }
        eval_curl_noise_with_rate(noise, at, along, u, rate);
        const Vec3 expected =
            (curl_at(noise, p + h * motion, h) - curl_at(noise, p - h * motion, -h)) / (2.0f * h);
        EXPECT_LT(glm::length(expected - Vec3(rate.x[5], rate.y[5], rate.z[5])), 0.02f);
        EXPECT_LT(glm::length(curl_at(noise, p) - Vec3(u.x[5], u.y[5], u.z[5])), 1e-5f);
    }
}

TEST(CurlNoise, TimeIsReducedWithoutLoss)
{
    // The same moment, reached as reference time and as offset, far from zero.
    const CurlNoiseParams params{0.5f, 0.7f, Vec3(0.0f, 1.0f, 0.0f), 3};
    const CurlNoise early = make_curl_noise(params, 36'000.0);
    const CurlNoise late = make_curl_noise(params, 36'001.0);
    const Vec3 p(0.1f, 0.2f, 0.3f);
    EXPECT_LT(glm::length(curl_at(early, p, 1.0f) - curl_at(late, p)), 1e-4f);
}

/// Without speed, or with next to none, nothing leaves its source; with hardly any drag the exact
/// solution is that without.
TEST(EmitterGuards, AllIsFiniteAtTheEndsOfTheRanges)
{
    for (const EmitterKind kind : all_kinds) {
        for (const float speed : {0.0f, 1e-30f, 1.0f}) {
            EmitterParams params = emitter(kind, 500);
            params.speed = speed;
            params.turbulence = 0.0f;
            for (const float drag : {0.0f, 1e-30f, 1e-12f, 1e-6f, 1e6f}) {
                params.drag = drag;
                const ParticleSet set = emit_particles(params, 0.8);
                ASSERT_GT(set.size(), 0u);
                for (size_t i = 0; i < set.size(); ++i) {
                    ASSERT_TRUE(is_finite(set.position[i]) && is_finite(set.velocity[i]))
                        << static_cast<int>(kind) << " " << speed << " " << drag;
                    ASSERT_LT(glm::length(set.position[i]), 100.0f);
                    ASSERT_TRUE(std::isfinite(set.age[i]));
                }
            }
        }
    }
    EmitterParams params = emitter(EmitterKind::Burst, 500);
    params.drag = 0.0f;
    const ParticleSet without = emit_particles(params, 0.8);
    params.drag = 1e-7f;
    const ParticleSet with = emit_particles(params, 0.8);
    for (size_t i = 0; i < with.size(); ++i) {
        ASSERT_LT(glm::length(with.position[i] - without.position[i]), 1e-5f) << i;
    }
}

}  // namespace
}  // namespace mote
