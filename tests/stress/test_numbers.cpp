// Random numbers at both ends, 0 and 1 - 2^-24, in every sampler and inversion.
#include <gtest/gtest.h>

#include "core/sampling.h"
#include "restir/candidates.h"
#include "restir/domains.h"
#include "restir/reservoir.h"
#include "restir/shift.h"
#include "stress/stress_scenes.h"
#include "volumes/ray_table.h"

namespace mote {
namespace {

constexpr float ends[] = {0.0f, 0x1p-24f, 0.5f, one_minus_epsilon};

std::vector<Vec2> pairs()
{
    std::vector<Vec2> out;
    for (const float x : ends) {
        for (const float y : ends) out.emplace_back(x, y);
    }
    return out;
}

bool is_unit(Vec3 v)
{
    return std::abs(glm::length(v) - 1.0f) < 1e-5f;
}

TEST(StressNumbers, TheEndsAreThoseOfTheGenerator)
{
    EXPECT_EQ(to_unit_float(0), 0.0f);
    EXPECT_EQ(to_unit_float(0xffffffffu), one_minus_epsilon);
}

TEST(StressNumbers, BasicSamplers)
{
    for (const float u : ends) {
        const float tau = sample_exponential(u);
        EXPECT_TRUE(std::isfinite(tau) && tau >= 0.0f);
    }
    for (const Vec2& u : pairs()) {
        EXPECT_TRUE(is_unit(sample_sphere(u)));
        EXPECT_LE(glm::length(sample_disk(u)), 1.0f + 1e-6f);
    }
}

TEST(StressNumbers, PhaseFunctions)
{
    for (const float g : {-0.999f, -1e-6f, 0.0f, 1e-6f, 0.5f, 0.999f}) {
        for (const float share : {0.0f, 1e-7f, 0.5f, one_minus_epsilon, 1.0f}) {
            const Phase phase{g, -0.999f, share};
            for (const Vec3& wo : {Vec3(0.0f, 0.0f, 1.0f), Vec3(0.0f, 0.0f, -1.0f),
                                   Vec3(1.0f, 0.0f, 0.0f), glm::normalize(Vec3(1.0f))}) {
                for (const Vec2& u : pairs()) {
                    const Vec3 wi = sample_phase(phase, wo, u);
                    ASSERT_TRUE(is_unit(wi)) << g << " " << u.x << " " << u.y;
                    const float pdf = phase_pdf(phase, wo, wi);
                    ASSERT_TRUE(std::isfinite(pdf) && pdf > 0.0f) << g << " " << u.x;
                }
            }
        }
    }
}

TEST(StressNumbers, Lights)
{
    Scene scene = test::lit_by_all(test::clumps(4.0f));
    scene.lights.push_back(TriangleLight{});
    for (const Light& light : scene.lights) {
        for (const Vec2& u : pairs()) {
            for (const Vec3& x : {Vec3(0.0f), Vec3(0.2f, 0.1f, 0.1f), Vec3(1e6f), Vec3(1e-6f)}) {
                const auto sample = sample_light(light, x, u);
                if (!sample) continue;
                ASSERT_TRUE(is_unit(sample->wi)) << light.index();
                ASSERT_TRUE(sample->distance >= 0.0f) << light.index();
                ASSERT_TRUE(std::isfinite(sample->pdf_dir) && sample->pdf_dir > 0.0f)
                    << light.index();
                ASSERT_TRUE(is_finite(sample->Li));
            }
        }
    }
}

TEST(StressNumbers, Cameras)
{
    Camera camera = test::stress_camera({0.5f, 0.4f, 3.2f});
    camera.lens_radius = 0.2f;
    camera.focus_distance = 3.0f;
    for (const Vec2& film : {Vec2(0.0f), Vec2(16.0f, 9.0f), Vec2(8.0f, 4.5f)}) {
        for (const Vec2& lens : pairs()) {
            for (const float time : ends) {
                const Ray ray = generate_ray(camera, film, lens, time);
                ASSERT_TRUE(is_finite(ray.o) && is_unit(ray.d));
            }
        }
    }
}

TEST(StressNumbers, FreeFlights)
{
    for (const float density : {1e-8f, 1.0f, 1e8f}) {
        Media media{{test::clumps(density)}};
        const Ray ray{{0.1f, 0.05f, 3.0f}, {0.0f, 0.0f, -1.0f}, 0.0f};
        const RayTable table(media.volumes[0], ray, {0.0f, infinity});
        for (const float u : ends) {
            const auto flight = table.sample(u);
            EXPECT_TRUE(!flight || (*flight >= 1.5f && *flight <= 4.5f)) << density << " " << u;
            const auto collision = table.sample_collision(u);
            ASSERT_TRUE(collision) << density << " " << u;
            EXPECT_TRUE(*collision >= 1.5f && *collision <= 4.5f) << density << " " << u;
            EXPECT_TRUE(std::isfinite(table.pdf(*collision)));
            const auto hit = invert_optical_depth(media.volumes[0], ray, {0.0f, infinity},
                                                  sample_exponential(u));
            EXPECT_TRUE(!hit || (hit->t >= 1.5f && hit->t <= 4.5f)) << density << " " << u;
        }
    }
}

TEST(StressNumbers, PixelDomainsAndBack)
{
    for (const float density : {1e-8f, 1.0f, 1e3f, 1e8f}) {
        const Scene scene = test::lit_by_all(test::clumps(density));
        const FrameDomain frame = test::make_domain(scene);
        for (uint32_t i = 0; i < 50; ++i) {
            Rng rng(5, 0, Stream::Test, i, 0);
            PixelDomain domain;
            BinCounts counts;
            make_pixel_domain(frame, test::random_ray(scene.camera, rng), domain, counts);
            if (domain.bins.empty()) continue;
            weigh_bins(frame, domain);
            float before = -1.0f;
            for (const float u : ends) {
                const RayPoint point = point_at(frame, domain, u);
                ASSERT_TRUE(is_finite(point.x) && std::isfinite(point.weight))
                    << density << " " << u;
                ASSERT_GE(point.weight, 0.0f);
                ASSERT_GE(point.s, before) << density << " " << u;
                before = point.s;
                const auto number = number_at(frame, domain, point.s);
                if (!number) continue;
                ASSERT_TRUE(number->u >= 0.0f && number->u < 1.0f) << density << " " << u;
                ASSERT_TRUE(std::isfinite(number->density) && number->density >= 0.0f);
            }
        }
    }
}

TEST(StressNumbers, SamplesAndTheirShifts)
{
    const Scene scene = test::lit_by_all(test::clumps(4.0f));
    RestirParams params;
    params.control_variate = false;
    const FrameDomain frame = test::make_domain(scene, params);
    for (uint32_t i = 0; i < 10; ++i) {
        Rng rng(6, 0, Stream::Test, i, 0);
        PixelDomain a;
        PixelDomain b;
        BinCounts counts;
        make_pixel_domain(frame, test::random_ray(scene.camera, rng), a, counts);
        make_pixel_domain(frame, test::random_ray(scene.camera, rng), b, counts);
        if (a.bins.empty() || b.bins.empty()) continue;
        weigh_bins(frame, a);
        weigh_bins(frame, b);
        for (const float u : ends) {
            for (const Vec2& v : pairs()) {
                for (int light = 0; light < static_cast<int>(frame.lights.size()); ++light) {
                    const bool is_sky = frame.lights[static_cast<size_t>(light)].kind ==
                                        SampledLightKind::Environment;
                    const PathSample y{u, light, is_sky ? sample_sphere(v) : Vec3(v, 0.0f)};
                    const Candidate c = evaluate(frame, a, y);
                    ASSERT_TRUE(is_finite(c.f)) << light << " " << u;
                    ASSERT_GE(std::min({c.f.x, c.f.y, c.f.z}), 0.0f) << light << " " << u;
                    for (const ShiftKind kind :
                         {ShiftKind::RandomNumbers, ShiftKind::World, ShiftKind::Fraction}) {
                        const auto moved = shift(kind, y, {frame, a}, {frame, b},
                                                 make_ray_map(a.ray, b.ray, Vec3(0.0f)));
                        if (!moved) continue;
                        ASSERT_TRUE(moved->y.u >= 0.0f && moved->y.u < 1.0f);
                        ASSERT_TRUE(std::isfinite(moved->jacobian) && moved->jacobian >= 0.0f);
                    }
                }
            }
        }
    }
}

TEST(StressNumbers, ReservoirsAtTheEnds)
{
    // The first sample of any weight is taken whatever u is; weights at both ends of double.
    for (const float u : ends) {
        for (const double w : {1e-300, 1e-30, 1.0, 1e30, 1e300}) {
            RisStream stream;
            EXPECT_TRUE(stream.add({0.5f, 1, Vec3(0.0f)}, 1.0f, w, 0.0f, u)) << u << " " << w;
            EXPECT_EQ(stream.y.light, 1);
        }
    }
}

}  // namespace
}  // namespace mote
