// Lights and caches at the edge of what floats can tell: choices stay distributions, and whatever
// is known of light stays finite.
#include <gtest/gtest.h>

#include <cmath>

#include "core/rng.h"
#include "core/sampling.h"
#include "restir/domains.h"
#include "restir/incident_light.h"
#include "restir/light_cells_scene.h"
#include "restir/room_scenes.h"
#include "restir/surface_domain.h"

namespace mote {
namespace {

const Vec3 wo(0.0f, 0.0f, 1.0f);

LocalLight light_at_place(int id, Vec3 position, float power, Vec3 facing = Vec3(0.0f))
{
    LocalLight light;
    light.id = id;
    light.position = position;
    light.power = power;
    light.facing = facing;
    return light;
}

/// Choices at x are a distribution, and `sample` knows it.
void expect_distribution(const LightCells& cells, int count, Vec3 x)
{
    EXPECT_NEAR(test::pmf_sum(cells, count, x), 1.0, 1e-5);
    for (const double u : {0.0, 0.3, 0.5, 0.9, 1.0 - 0x1p-53}) {
        const LightPick pick = cells.sample(x, u);
        ASSERT_TRUE(pick.light >= 0 && pick.light < count) << u;
        EXPECT_GT(pick.pmf, 0.0f);
        EXPECT_FLOAT_EQ(pick.pmf, cells.pmf(pick.light, x));
    }
}

TEST(LightCellsGuards, ChoicesAreADistributionWhateverThePowers)
{
    const Vec3 here(0.1f, 0.0f, 0.0f);
    const Vec3 places[] = {Vec3(0.0f, 3.0f, 0.0f), Vec3(0.15f, 0.0f, 0.0f)};
    for (const float power : {0x1p-149f, 1e-30f, 1.0f, 3e38f}) {
        for (const float other : {0x1p-149f, 1.0f, 3e38f}) {
            for (const Vec3& facing : {Vec3(0.0f), Vec3(0.0f, 1.0f, 0.0f)}) {
                for (const Vec3& there : places) {
                    const LocalLight lights[] = {light_at_place(0, here, power, facing),
                                                 light_at_place(1, there, other, facing)};
                    const LightCells cells({}, lights, Vec3(0.0f));
                    for (const Vec3& x : {here, there, Vec3(0.0f), Vec3(1e15f), Vec3(infinity)}) {
                        expect_distribution(cells, 2, x);
                    }
                }
            }
        }
    }
}

/// Within an eighth of a cell (here 1 m, without any) of a light nothing is known about who is
/// nearer: the other one's share is that at this distance, not 1 %.
TEST(LightCellsGuards, ALightAtThePointItselfDoesNotTakeAllChoices)
{
    const LocalLight lights[] = {light_at_place(0, Vec3(0.0f), 1.0f),
                                 light_at_place(1, Vec3(0.25f, 0.0f, 0.0f), 1.0f)};
    const LightCells cells({}, lights, Vec3(0.0f));
    // Squared distances 1/64 and 1/16.
    EXPECT_NEAR(cells.pmf(1, Vec3(0.0f)), 0.98f * 0.2f + 0.01f, 1e-6f);
}

/// A light that shines away brings little, but not less than 1/20 of its mean.
TEST(LightCellsGuards, LightsThatShineAwayKeepAShare)
{
    const Vec3 away(-1.0f, 0.0f, 0.0f);
    const LocalLight lights[] = {light_at_place(0, Vec3(2.0f, 0.0f, 0.0f), 1.0f),
                                 light_at_place(1, Vec3(-2.0f, 0.0f, 0.0f), 1.0f, away)};
    const LightCells cells({}, lights, Vec3(0.0f));
    EXPECT_NEAR(cells.pmf(1, Vec3(0.0f)), 0.98f * 0.05f / 1.05f + 0.01f, 1e-5f);
}

/// What cells are told: nothing, too much, and no numbers.
TEST(LightCellsGuards, CellsStayDistributionsWhateverTheyAreTold)
{
    const std::vector<LocalLight> lights = test::random_lights(300);
    LightCells cells(test::clumpy_media(), lights, test::test_eye);
    const float values[] = {0.0f, -1.0f, 3e38f, infinity, std::nanf("")};
    for (const float value : values) {
        for (const bool all : {true, false}) {
            cells.overwrite([&](size_t entry) { return all || entry % 3 == 0 ? value : 1e-3f; },
                            test::test_eye);
            for (uint32_t k = 0; k < 20; ++k) {
                const Vec3 x = test::some_point(k);
                expect_distribution(cells, 300, x);
                EXPECT_TRUE(cells.inscatter(x) > 0.0f && cells.inscatter(x) < infinity) << value;
            }
        }
    }
}

/// Cells that know nothing choose by power and evenly: 300 lights of about equal power.
TEST(LightCellsGuards, CellsThatKnowNothingChooseEvenly)
{
    const std::vector<LocalLight> lights = test::random_lights(300);
    LightCells cells(test::clumpy_media(), lights, test::test_eye);
    cells.overwrite([](size_t) { return 0.0f; }, test::test_eye);
    for (int i = 0; i < 300; ++i) {
        EXPECT_LT(cells.pmf(i, Vec3(0.1f)), 0.03f) << i;
        EXPECT_GT(cells.pmf(i, Vec3(0.1f)), 1e-4f) << i;
    }
}

/// However many clusters are asked for; and where everything goes to the first of many lights the
/// others keep a quantum.
TEST(LightCellsGuards, EveryLightKeepsAQuantumWhateverTheParameters)
{
    const std::vector<LocalLight> lights = test::random_lights(300);
    LightCellsParams params;
    params.edge_voxels = 0.0f;
    params.most_cells = 500;
    for (const int most : {0, 300, 100'000}) {
        for (const float floor : {1e-3f, 1.0f}) {
            params.most_clusters = most;
            params.floor = floor;
            LightCells cells(test::clumpy_media(), lights, test::test_eye, params);
            expect_distribution(cells, 300, Vec3(0.1f));
            const size_t n = cells.entry_count() / cells.cell_count();
            cells.overwrite([&](size_t entry) { return entry % n == 0 ? 1.0f : 0.0f; },
                            test::test_eye);
            expect_distribution(cells, 300, Vec3(0.1f));
            for (int i = 0; i < 300; ++i) EXPECT_GT(cells.pmf(i, Vec3(0.1f)), 0.0f);
        }
    }
}

TEST(LightCellsGuards, FaintLightsAreInscatteredAboveZero)
{
    std::vector<LocalLight> lights = test::random_lights(3);
    for (LocalLight& light : lights) light.power = 0x1p-149f;
    const LightCells cells(test::clumpy_media(), lights, test::test_eye);
    for (uint32_t k = 0; k < 20; ++k) EXPECT_GT(cells.inscatter(test::some_point(k)), 0.0f);
}

/// From right in the middle of a cell an eye has no direction; what is known there stays usual.
TEST(LightCellsGuards, AnEyeInTheMiddleOfACellIsNothingSpecial)
{
    const Media media = test::clumpy_media();
    const LightCellsParams params;
    const SmokeCells smoke = find_smoke_cells(media, params.edge_voxels, params.most_cells);
    const Vec3i middle = smoke.lattice.count / 2;
    ASSERT_EQ(smoke.marks[smoke.lattice.index(middle)], SmokeCells::Smoke);
    const Vec3 eye = smoke.lattice.centre(middle);
    const LocalLight lights[] = {
        light_at_place(0, eye + 0.2f * smoke.lattice.cell, 1.0f),
        light_at_place(1, eye + 10.0f * smoke.lattice.cell, 1.0f),
    };
    const LightCells cells(media, lights, eye, params);
    EXPECT_GT(cells.pmf(0, eye), 0.9f);
    expect_distribution(cells, 2, eye);
    const LightCells beside(media, lights, eye + Vec3(0.01f * smoke.lattice.cell, 0.0f, 0.0f));
    EXPECT_LT(cells.inscatter(eye), 100.0f * beside.inscatter(eye));
}

/// All lights are candidates, and maps know of another density.
FrameDomain candidates_with(const Scene& scene, float density_of_maps)
{
    FrameDomain frame = test::candidates_domain(scene);
    LightCaches caches = *frame.caches;
    Media media = scene.media;
    media.volumes[0].density_scale = density_of_maps;
    for (LightCaches::Distant& distant : caches.distant) {
        distant.map = std::make_shared<TransmittanceMap>(media, distant.direction);
    }
    frame.caches = std::make_shared<const LightCaches>(std::move(caches));
    return frame;
}

/// Two suns, one of them right behind strongly forward scattering smoke, and two lamps if they
/// have any intensity.
Scene suns_and_lamps(float irradiance, float intensity)
{
    Scene scene = test::lit_clumps(6.0f);
    scene.media.volumes[0].phase.g = 0.9f;
    finalize(scene.media.volumes[0]);
    scene.lights = {DistantLight{-wo, Spectrum(irradiance)},
                    DistantLight{Vec3(0.0f, 1.0f, 0.0f), Spectrum(irradiance)}};
    if (intensity == 0.0f) return scene;
    scene.lights.push_back(PointLight{Vec3(0.4f, 0.1f, 0.0f), Spectrum(intensity)});
    scene.lights.push_back(PointLight{Vec3(-0.4f, 0.1f, 0.0f), Spectrum(intensity)});
    return scene;
}

void expect_choices(const FrameDomain& frame, Vec3 x)
{
    double sum = 0.0;
    for (int i = 0; i < static_cast<int>(frame.lights.size()); ++i) {
        const float pmf = light_pmf(frame, i, x, wo);
        EXPECT_GT(pmf, 0.0f) << i;
        sum += static_cast<double>(pmf);
    }
    EXPECT_NEAR(sum, 1.0, 1e-5);
    for (const double u : {0.0, 0.25, 0.5, 0.999, 1.0 - 0x1p-53}) {
        const SampledChoice choice = choose_light(frame, x, wo, u);
        ASSERT_TRUE(choice.light >= 0 && choice.light < static_cast<int>(frame.lights.size()));
        EXPECT_FLOAT_EQ(choice.pmf, light_pmf(frame, choice.light, x, wo));
    }
}

/// No light at all in the caches; light without end; as it is.
TEST(LightChoiceGuards, ChoicesAreADistributionWhateverTheCachesKnow)
{
    for (const float irradiance : {0x1p-149f, 1.0f, 3e38f}) {
        for (const float intensity : {0.0f, 1e-37f, 1.0f, 1e37f}) {
            const Scene scene = suns_and_lamps(irradiance, intensity);
            for (const float density : {1e-6f, 1e30f}) {
                const FrameDomain frame = candidates_with(scene, density);
                EXPECT_EQ(frame.samples_local, intensity > 0.0f);
                for (const Vec3& x : {Vec3(0.0f), Vec3(0.3f, 0.2f, 0.1f), Vec3(5.0f)}) {
                    expect_choices(frame, x);
                }
            }
        }
    }
}

TEST(LightChoiceGuards, WeightsOfBinsAreFiniteWhateverTheCachesKnow)
{
    for (const float irradiance : {0x1p-149f, 1.0f, 3e38f}) {
        for (const float intensity : {0.0f, 1.0f, 1e37f}) {
            for (const float density : {1e-6f, 1e30f}) {
                const Scene scene = suns_and_lamps(irradiance, intensity);
                const FrameDomain frame = candidates_with(scene, density);
                PixelDomain domain;
                BinCounts counts;
                make_pixel_domain(frame, {Vec3(0.1f, 0.0f, 4.0f), -wo}, domain, counts);
                weigh_bins(frame, domain);
                EXPECT_TRUE(domain.Z() > 0.0f && domain.Z() < infinity)
                    << irradiance << " " << intensity << " " << density;
            }
        }
    }
}

/// The last choice goes to the last light even where the shares' rounded sum is below 1.
TEST(LightChoiceGuards, TheLastNumberChoosesTheLastLight)
{
    Scene scene = test::lit_clumps(6.0f);
    for (int i = 0; i < 40; ++i) {
        Rng rng(7, 0, Stream::Test, static_cast<uint32_t>(i), 0);
        scene.lights.push_back(
            DistantLight{sample_sphere(rng.uniform2()), Spectrum(rng.uniform())});
    }
    const FrameDomain frame = candidates_with(scene, 6.0f);
    for (uint32_t k = 0; k < 100; ++k) {
        const SampledChoice choice =
            choose_light(frame, 0.1f * test::some_point(k), wo, 1.0 - 0x1p-53);
        EXPECT_EQ(choice.light, 39);
    }
}

TEST(LightChoiceGuards, LightsWithoutAFiniteArrivalDoNotShine)
{
    Scene scene = test::flame_in_smoke().scene;
    // So large and so near that the density of its directions is 0.
    scene.lights = {
        QuadLight{Vec3(0.0f), {0.0f, 0.0f, 1e3f}, {1e3f, 0.0f, 0.0f}, Spectrum(1.0f), true}};
    const FrameDomain frame = test::candidates_domain(scene);
    const Vec3 near(0.0f, 1e-21f, 0.0f);
    const auto quad = light_at(frame, {0.0f, 0, Vec3(0.0f)}, near, 0.5f);
    EXPECT_TRUE(!quad || is_finite(quad->L));
    const Vec3 inside(0.2f, -0.6f, 0.1f);
    EXPECT_FALSE(light_at(frame, {0.0f, 1, inside}, inside, 0.5f));
    EXPECT_TRUE(light_at(frame, {0.0f, 1, inside}, inside + 0.1f, 0.5f));
}

TEST(CandidateGuards, LightIsFiniteWhereverItIsBright)
{
    Scene scene = test::lit_clumps(6.0f);
    scene.lights = {PointLight{Vec3(0.0f), Spectrum(1e37f)},
                    PointLight{Vec3(0.1f, 0.0f, 0.0f), Spectrum(1e37f)}};
    const FrameDomain frame = test::candidates_domain(scene);
    std::vector<Candidate> candidates;
    for (uint32_t i = 0; i < 200; ++i) {
        PixelDomain domain;
        BinCounts counts;
        make_pixel_domain(frame, {Vec3(1e-4f, 0.0f, 4.0f), -wo}, domain, counts);
        weigh_bins(frame, domain);
        Rng rng(1, 0, Stream::Test, i, 0);
        draw_candidates(frame, domain, 64, rng, candidates);
    }
    ASSERT_FALSE(candidates.empty());
    for (const Candidate& c : candidates) {
        EXPECT_TRUE(is_finite(c.f) && max_component(c.f) > 0.0f);
        EXPECT_GT(c.density, 0.0f);
    }
}

/// The last of very many strata ends at 1, as do numbers that are rounded up to it. All but the
/// last numbers stand for a bin without depth here, so that drawing is quick.
TEST(CandidateGuards, NumbersStayBelowOne)
{
    Scene scene = test::lit_clumps(6.0f);
    scene.lights = {PointLight{Vec3(0.0f), Spectrum(1.0f)}};
    const FrameDomain frame = test::candidates_domain(scene);
    PixelDomain domain;
    BinCounts counts;
    make_pixel_domain(frame, {Vec3(0.0f, 0.0f, 4.0f), -wo}, domain, counts);
    weigh_bins(frame, domain);
    ASSERT_GT(domain.bins.count, 2);
    domain.bins.tau[1] = 0.0f;
    for (int k = 1; k <= domain.bins.count; ++k) {
        domain.cdf[k] = 1.0f + 1e-5f * static_cast<float>(k);
    }
    std::vector<Candidate> candidates;
    // Items whose last number is rounded up: one of 128.
    for (const uint32_t item : {56u, 130u, 299u}) {
        Rng rng(2, 0, Stream::Test, item, 0);
        draw_candidates(frame, domain, 1 << 18, rng, candidates);
    }
    ASSERT_FALSE(candidates.empty());
    for (const Candidate& c : candidates) EXPECT_LT(c.y.u, 1.0f);
}

/// Behind whatever is opaque, up to the largest extinction of all, the light is still thought
/// possible.
TEST(CachedVisibilityGuards, IsAboveZeroAndFinite)
{
    const Scene scene = suns_and_lamps(1.0f, 1.0f);
    for (const float density : {1e-6f, 1.0f, 1e5f, 1e30f}) {
        const FrameDomain frame = candidates_with(scene, density);
        for (uint32_t k = 0; k < 50; ++k) {
            const Vec3 x = test::some_point(k);
            for (const int light : {0, 1}) {
                const float T =
                    cached_visibility(frame, {0.0f, light, Vec3(0.0f)}, x, {wo, infinity, {}});
                EXPECT_TRUE(T >= 1e-3f && T <= 1.0f) << T << ", density " << density;
            }
        }
    }
}

TEST(CachedVisibilityGuards, IsAboveZeroAndFiniteInEveryDirection)
{
    Scene scene = test::lit_clumps(6.0f);
    scene.environment = test::image_sky();
    FrameDomain frame = test::candidates_domain(scene);
    for (const float density : {1e-6f, 1.0f, 1e5f, 1e30f}) {
        LightCaches caches = *frame.caches;
        Media media = scene.media;
        media.volumes[0].density_scale = density;
        DirectionTransmittanceParams params;
        params.hats = {3, 5};
        caches.directions = std::make_shared<DirectionTransmittance>(media, params);
        frame.caches = std::make_shared<const LightCaches>(std::move(caches));
        for (uint32_t k = 0; k < 50; ++k) {
            const Vec3 x = 0.1f * test::some_point(k);
            const float T = cached_visibility(frame, {0.0f, 0, wo}, x, {wo, infinity, {}});
            EXPECT_TRUE(T >= 1e-3f && T <= 1.0f) << T << ", density " << density;
        }
    }
}

TEST(LocalLightGuards, LightsWithoutPowerOrPlaceAreLeftOut)
{
    const float huge = 3e38f;
    const Vec3 u(1.0f, 0.0f, 0.0f);
    const Vec3 v(0.0f, 0.0f, 1.0f);
    const Light lamps[] = {
        PointLight{Vec3(0.0f), Spectrum(0.0f)},
        PointLight{Vec3(0.0f), Spectrum(huge)},
        PointLight{Vec3(infinity, 0.0f, 0.0f), Spectrum(1.0f)},
        PointLight{Vec3(std::nanf("")), Spectrum(1.0f)},
        SphereLight{Vec3(0.0f), 1e22f, Spectrum(1e-30f)},               // infinitely wide
        QuadLight{Vec3(0.0f), 1e-30f * u, 1e-30f * v, Spectrum(1.0f)},  // no area
        QuadLight{Vec3(0.0f), 1e20f * u, 1e20f * v, Spectrum(1e-30f)},
        TriangleLight{Vec3(0.0f), 1e-30f * u, 1e-30f * v, Spectrum(1.0f)},
        TriangleLight{Vec3(0.0f), 1e20f * u, 1e-20f * v, Spectrum(1.0f)},
    };
    for (const LocalLight& light : local_lights(lamps)) ADD_FAILURE() << light.id;
    const Light good[] = {QuadLight{Vec3(0.0f), u, v, Spectrum(1.0f)}};
    EXPECT_EQ(local_lights(good).size(), 1u);
}

}  // namespace
}  // namespace mote
