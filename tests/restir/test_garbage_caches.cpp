#include <gtest/gtest.h>

#include <cstdlib>

#include "restir/runs.h"

namespace mote {
namespace {

using test::TestScene;

/// Lights of every kind that a cache knows of.
TestScene lit_by_all()
{
    TestScene test = test::overlapping();
    test.name = "all kinds of lights";
    test.scene.media.volumes.push_back(test::flame());
    test.scene.lights.push_back(SphereLight{{0.3f, 0.2f, 0.1f}, 0.15f, {1.0f, 0.5f, 0.5f}});
    test.scene.lights.push_back(
        DistantLight{glm::normalize(Vec3(-0.7f, 0.1f, -0.5f)), {0.0f, 0.2f, 1.0f}});
    return test;
}

/// The same places, another medium: what a cache knew before everything changed.
Media other_media(float density_scale)
{
    Media media;
    for (int i = 0; i < 3; ++i) {
        Volume volume = test::unit_sphere(12);
        volume.density_scale = density_scale;
        volume.world_from_object = test::turned({0.5f, -0.3f * static_cast<float>(i), 0.2f}, 1.0);
        finalize(volume);
        media.volumes.push_back(volume);
    }
    return media;
}

/// Parts that know a wrong medium, wrong light and a wrong camera.
LightCaches stale_caches(const Scene& scene, float density_scale)
{
    const Media media = other_media(density_scale);
    LightCaches caches = *make_light_caches(scene, {10'000}, nullptr);
    for (LightCaches::Distant& distant : caches.distant) {
        distant.map = std::make_shared<TransmittanceMap>(
            media, Vec3(distant.direction.z, -distant.direction.x, distant.direction.y));
    }
    DirectionTransmittanceParams params;
    params.hats = {3, 5};
    caches.directions = std::make_shared<DirectionTransmittance>(media, params);
    std::vector<Spectrum> radiance;
    for (int k = 0; k < params.hats.count(); ++k) {
        radiance.push_back(k % 3 == 0 ? Spectrum(0.0f)
                                      : Spectrum(0.1f, 3.0f, 0.01f * static_cast<float>(k)));
    }
    caches.environment.emplace(caches.directions, radiance, media, Vec3(-2.0f, 5.0f, 1.0f));
    caches.guess = std::make_shared<const LightGuess>(LightGuess{media, 1.0f});
    return caches;
}

using Value = float (*)(size_t);

LightCaches with_cells(LightCaches caches, Value value)
{
    caches.cells->overwrite(value, Vec3(1.0f, 0.0f, 0.0f));
    return caches;
}

float zero(size_t /*entry*/)
{
    return 0.0f;
}

float noise(size_t entry)
{
    Rng rng(5, 0, Stream::Test, static_cast<uint32_t>(entry), 0);
    return std::pow(10.0f, 8.0f * rng.uniform() - 4.0f);
}

float spikes(size_t entry)
{
    return entry % 37 == 0 ? 1e6f : 1e-6f;
}

/// Sums of these are infinite.
float huge(size_t entry)
{
    return entry % 2 == 0 ? 3e38f : 0.0f;
}

struct Garbage {
    const char* name;
    LightCaches caches;
};

std::vector<Garbage> garbage(const Scene& scene)
{
    const LightCaches fresh = *make_light_caches(scene, {10'000}, nullptr);
    LightCaches bright = fresh;  // nothing casts a shadow
    for (LightCaches::Distant& distant : bright.distant) {
        distant.map = std::make_shared<TransmittanceMap>();
    }
    bright.guess = std::make_shared<const LightGuess>(LightGuess{other_media(1e-6f), 1.0f});
    LightCaches dark = fresh;  // all is shadow
    dark.guess = std::make_shared<const LightGuess>(LightGuess{other_media(1e4f), 0.0f});
    for (LightCaches::Distant& distant : dark.distant) {
        distant.map = std::make_shared<TransmittanceMap>(other_media(1e4f), distant.direction);
    }
    dark.environment.emplace(
        fresh.directions, std::vector<Spectrum>(fresh.environment_radiance.size(), Spectrum(0.0f)),
        scene.media, Vec3(0.0f));
    return {{"another medium", stale_caches(scene, 2.0f)},
            {"nothing in the way, spikes", with_cells(bright, spikes)},
            {"black, zeros", with_cells(dark, zero)},
            {"black, overflow", with_cells(dark, huge)},
            {"thick medium, noise", with_cells(stale_caches(scene, 50.0f), noise)}};
}

void expect_unbiased(const test::Effort& effort, bool tell)
{
    const TestScene test = lit_by_all();
    const TileStats reference = test::reference_runs(test, effort);
    uint32_t seed = 1;
    for (const Garbage& g : garbage(test.scene)) {
        for (const bool control_variate : {true, false}) {
            RenderDescription render =
                test::description(test, EstimatorKind::Restir, effort.samples);
            render.restir.control_variate = control_variate;
            const TileStats tested = test::runs_with_caches(
                test, std::make_shared<const LightCaches>(g.caches), render, effort.runs, seed);
            seed += 1000;
            const RunComparison comparison = compare_runs(tested, reference);
            const std::string text = test::summary(
                std::string(g.name) + (control_variate ? "" : ", no control variate"), comparison);
            EXPECT_GT(comparison.p, test::alarm) << text;
            EXPECT_EQ(comparison.non_finite, 0) << text;
            if (tell) std::printf("%s\n", text.c_str());
        }
    }
}

TEST(GarbageCachesStat, TheImageStaysUnbiasedAndFinite)
{
    expect_unbiased({32, 6, 100}, false);
}

TEST(GarbageCachesLong, TheImageStaysUnbiasedAndFinite)
{
    if (!std::getenv("MOTE_LONG_TESTS")) GTEST_SKIP() << "MOTE_LONG_TESTS is not set";
    expect_unbiased({64, 60, 800}, true);
}

TEST(GarbageCachesStat, ClosedFormsAloneShowWhatTheCachesGotWrong)
{
    // Negative control: the same caches without the corrections.
    const TestScene test = lit_by_all();
    const test::Effort effort{16, 4, 50};
    const TileStats reference = test::reference_runs(test, effort);
    for (const Garbage& g : garbage(test.scene)) {
        RenderDescription render = test::description(test, EstimatorKind::Restir, effort.samples);
        render.restir.corrections = false;
        const TileStats tested = test::runs_with_caches(
            test, std::make_shared<const LightCaches>(g.caches), render, effort.runs, 1);
        EXPECT_LT(compare_runs(tested, reference).p, test::alarm) << g.name;
    }
}

}  // namespace
}  // namespace mote
