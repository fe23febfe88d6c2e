#include <gtest/gtest.h>

#include "clouds.h"
#include "core/parallel.h"
#include "core/sampling.h"
#include "restir/environment_cache.h"
#include "restir/media_key.h"
#include "scene/environment.h"

namespace mote {
namespace {

using test::two_clouds;

constexpr Interval everything{0.0f, infinity};
const Vec3 camera(-3.0f, 1.0f, 2.0f);

EnvironmentLight constant_sky()
{
    return {Spectrum(0.5f, 0.7f, 1.0f), nullptr, Mat3(1.0f)};
}

/// Bright in one octant, smoothly darker to the others.
EnvironmentLight lopsided_sky()
{
    Buffer2D<Spectrum> pixels(64, 32);
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 64; ++x) {
            const float across =
                1.0f + std::sin(2.0f * pi * (static_cast<float>(x) - 10.0f) / 64.0f);
            pixels.at(x, y) = Spectrum(0.1f + across * (1.0f - static_cast<float>(y) / 32.0f));
        }
    }
    return {Spectrum(1.0f), make_environment_map(std::move(pixels), "test"),
            make_frame(glm::normalize(Vec3(0.2f, 0.3f, 0.9f)))};
}

/// Brighter above than below, with a sun.
EnvironmentLight sunny_sky()
{
    Buffer2D<Spectrum> pixels(64, 32);
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 64; ++x) {
            pixels.at(x, y) = (y < 16 ? 1.0f : 0.2f) * Spectrum(0.5f, 0.7f, 1.0f);
        }
    }
    pixels.at(10, 5) = Spectrum(300.0f, 280.0f, 200.0f);
    return {Spectrum(1.0f), make_environment_map(std::move(pixels), "test"), Mat3(1.0f)};
}

Media clouds_with(Phase a, Phase b)
{
    Media media = two_clouds();
    media.volumes[0].phase = a;
    media.volumes[1].phase = b;
    return media;
}

std::shared_ptr<const DirectionTransmittance> transmittances(const Media& media,
                                                             DirectionHats hats = {4, 8})
{
    DirectionTransmittanceParams params;
    params.hats = hats;
    params.node_spacing = 0.12f;
    return std::make_shared<const DirectionTransmittance>(media, params);
}

EnvironmentCache make_cache(const Media& media, const EnvironmentLight& sky,
                            DirectionHats hats = {4, 8}, Vec3 eye = camera)
{
    return {transmittances(media, hats), mean_radiance(sky, hats), media, eye};
}

/// Midpoint rule on a grid whose lines include those of the hats: exact for functions that are
/// bilinear between them.
Vec3d integral_over_directions(const EnvironmentCache& cache, int phase, Vec3 x,
                               const DirectionHats& hats)
{
    const int rows = 2 * hats.bands;
    const int columns = 2 * hats.azimuths;
    Vec3d sum(0.0);
    for (int i = 0; i < rows; ++i) {
        for (int j = 0; j < columns; ++j) {
            const double y = 1.0 - 2.0 * (i + 0.5) / rows;
            const double r = std::sqrt(1.0 - y * y);
            const double phi = 2.0 * std::numbers::pi * (j + 0.5) / columns;
            const Vec3 wi(Vec3d(r * std::sin(phi), y, r * std::cos(phi)));
            sum += Vec3d(cache.directional(phase, x, Vec3(1.0f, 0.0f, 0.0f), wi));
        }
    }
    return sum * (4.0 * std::numbers::pi / (rows * columns));
}

/// Midpoint rule over the random numbers of sample_phase: for lobes too narrow for the above.
Vec3d integral_over_lobes(const EnvironmentCache& cache, const Phase& phase, Vec3 x, Vec3 wo,
                          int rows, int columns)
{
    Vec3d sum(0.0);
    for (int i = 0; i < rows; ++i) {
        for (int j = 0; j < columns; ++j) {
            const Vec2 u((static_cast<float>(i) + 0.5f) / static_cast<float>(rows),
                         (static_cast<float>(j) + 0.5f) / static_cast<float>(columns));
            const Vec3 wi = sample_phase(phase, wo, u);
            sum += Vec3d(cache.directional(0, x, wo, wi)) / double(phase_pdf(phase, wo, wi));
        }
    }
    return sum / (1.0 * rows * columns);
}

TEST(EnvironmentCache, DirectionalIntegratesToInscatterInNarrowLobes)
{
    struct Case {
        Phase phase;
        int rows;
        double tolerance;
    };
    // Lines of the rule and of the hats coincide across single lobes; in azimuth, and for two
    // lobes, the error is about 1/12 of the square of a step's share of a hat. Measured: 5e-7,
    // 8e-5.
    const DirectionHats hats{6, 12};
    const Case cases[] = {{{-0.9f, 0.0f, 0.0f}, 12, 3e-6},
                          {{0.95f, 0.0f, 0.0f}, 12, 3e-6},
                          {{0.999f, 0.0f, 0.0f}, 12, 3e-6},
                          {{0.8f, -0.5f, 0.3f}, 300, 3e-4}};
    const auto cached = transmittances(two_clouds(), hats);
    for (const EnvironmentLight& sky : {constant_sky(), sunny_sky()}) {
        for (const Case& c : cases) {
            const Media media = clouds_with(c.phase, Phase{});
            const EnvironmentCache cache(cached, mean_radiance(sky, hats), media, camera);
            const Bounds3 bounds = test::bounds_of(media);
            for (uint32_t i = 0; i < 6; ++i) {
                Rng rng(1, 0, Stream::Test, i, 0);
                const Vec3 x = bounds.lo + (rng.uniform3() * 1.4f - 0.2f) * bounds.extent();
                // The direction of the ray need not be the one of the bake, quite.
                const Vec3 wo = glm::normalize(camera + 0.1f * rng.uniform3() - x);
                const Vec3d sum =
                    integral_over_lobes(cache, c.phase, x, wo, c.rows, c.rows > 12 ? 240 : 480);
                const Vec3d exact(cache.inscatter(0, x));
                EXPECT_LT(glm::length(sum - exact), c.tolerance * glm::length(exact)) << c.phase.g;
                EXPECT_GT(exact.y, 0.0);
            }
        }
    }
}

TEST(EnvironmentCache, DirectionalIntegratesToInscatter)
{
    const Phase phases[] = {{0.0f, 0.0f, 0.0f},
                            {0.2f, 0.0f, 0.0f},
                            {0.6f, 0.0f, 0.0f},
                            {-0.5f, 0.0f, 0.0f},
                            {0.4f, -0.6f, 0.3f}};
    for (const DirectionHats& hats : {DirectionHats{6, 12}, DirectionHats{9, 7}}) {
        const auto cached = transmittances(two_clouds(), hats);
        for (const EnvironmentLight& sky : {constant_sky(), sunny_sky()}) {
            for (const Phase& phase : phases) {
                const Media media = clouds_with(phase, Phase{});
                const EnvironmentCache cache(cached, mean_radiance(sky, hats), media, camera);
                const Bounds3 bounds = test::bounds_of(media);
                double total = 0.0;
                for (uint32_t i = 0; i < 20; ++i) {
                    Rng rng(1, 0, Stream::Test, i, 0);
                    // In smoke and out of it: some nodes are inactive.
                    const Vec3 x = bounds.lo + (rng.uniform3() * 1.4f - 0.2f) * bounds.extent();
                    const Vec3d sum = integral_over_directions(cache, 0, x, hats);
                    const Vec3d exact(cache.inscatter(0, x));
                    // Float sums of a hundred terms.
                    EXPECT_LT(glm::length(sum - exact), 1e-5 * glm::length(exact)) << phase.g;
                    total += exact.y;
                }
                EXPECT_GT(total, 0.1);
            }
        }
    }
}

TEST(EnvironmentCache, ADirectionalThatForgetsTheSunIsRejected)
{
    const Media media = two_clouds();
    const EnvironmentCache dull = make_cache(media, constant_sky());
    const EnvironmentCache sunny = make_cache(media, sunny_sky());
    const Vec3d sum = integral_over_directions(dull, 0, Vec3(0.2f), {4, 8});
    const Vec3d exact(sunny.inscatter(0, Vec3(0.2f)));
    EXPECT_GT(glm::length(sum - exact), 1e-3 * glm::length(exact));
}

/// Single scattering of the environment at x towards the camera, by brute force: 1024 exact rays.
double exact_inscatter(const Media& media, const EnvironmentLight& sky, const Phase& phase, Vec3 x)
{
    double sum = 0.0;
    constexpr int n = 32;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            const Vec3 wi = sample_phase(
                phase, glm::normalize(camera - x),
                {(static_cast<float>(i) + 0.5f) / n, (static_cast<float>(j) + 0.5f) / n});
            const float T = std::exp(-optical_depth(media, {x, wi, 0.5f}, everything));
            sum += static_cast<double>(T * luminance(environment_radiance(sky, wi)));
        }
    }
    return sum / (n * n);
}

/// Mean square error of inscatter(), and what it was if light came from the other side, over the
/// mean square of the truth.
std::pair<double, double> inscatter_errors(const EnvironmentLight& sky, float g)
{
    const Media media = clouds_with({g, 0.0f, 0.0f}, {g, 0.0f, 0.0f});
    const EnvironmentCache cache = make_cache(media, sky, {6, 12});
    EnvironmentLight turned = sky;
    turned.map_from_world = sky.map_from_world * Mat3(-1.0f, 0.0f, 0.0f,  //
                                                      0.0f, 1.0f, 0.0f,   //
                                                      0.0f, 0.0f, -1.0f);
    double error = 0.0;
    double turned_error = 0.0;
    double square = 0.0;
    for (uint32_t i = 0; i < 30; ++i) {
        Rng rng(2, 0, Stream::Test, i, 0);
        const Vec3 x = Vec3(-0.5f) + rng.uniform3();
        if (!(test::sigma_of(media, x) > 0.0f)) continue;
        const double exact = exact_inscatter(media, sky, media.volumes[0].phase, x);
        const double other = exact_inscatter(media, turned, media.volumes[0].phase, x);
        const double cached = static_cast<double>(luminance(cache.inscatter(0, x)));
        error += (cached - exact) * (cached - exact);
        turned_error += (cached - other) * (cached - other);
        square += exact * exact;
    }
    EXPECT_GT(square, 0.0);
    return {error / square, turned_error / square};
}

TEST(EnvironmentCache, InscatterIsCloseToTheTruth)
{
    // Measured: 0.008, 0.005, 0.037, 0.012; against light from the other side 0.07 to 0.16.
    for (const float g : {0.0f, 0.6f, -0.9f, 0.95f}) {
        const auto [error, turned] = inscatter_errors(lopsided_sky(), g);
        EXPECT_LT(error, 0.06) << g;
        EXPECT_GT(turned, 2.5 * error) << g;
    }
    EXPECT_LT(inscatter_errors(constant_sky(), 0.3f).first, 0.02);
}

TEST(DirectionTransmittance, AgreesWithExactTransmittance)
{
    const Media media = two_clouds();
    const auto cached = transmittances(media, {6, 12});
    double error = 0.0;
    double square = 0.0;
    for (uint32_t i = 0; i < 3000; ++i) {
        Rng rng(3, 0, Stream::Test, i, 0);
        const Vec3 x = Vec3(-0.5f) + rng.uniform3();
        if (!(test::sigma_of(media, x) > 0.0f)) continue;
        const Vec3 wi = sample_sphere(rng.uniform2());
        const float exact = std::exp(-optical_depth(media, {x, wi, 0.5f}, everything));
        error += static_cast<double>(sqr(cached->transmittance(x, wi) - exact));
        square += static_cast<double>(sqr(exact));
    }
    EXPECT_LT(error, 0.1 * square);  // measured: 0.05
    EXPECT_EQ(cached->transmittance(Vec3(50.0f), Vec3(0.0f, 1.0f, 0.0f)), 1.0f);
}

TEST(EnvironmentCache, VolumesShareEqualPhases)
{
    const Phase a{0.3f, 0.0f, 0.0f};
    const EnvironmentCache same = make_cache(clouds_with(a, a), constant_sky());
    EXPECT_EQ(same.phase_of(0), same.phase_of(1));
    const EnvironmentCache distinct =
        make_cache(clouds_with(a, {0.4f, 0.0f, 0.0f}), constant_sky());
    EXPECT_NE(distinct.phase_of(0), distinct.phase_of(1));
}

TEST(EnvironmentCache, BakingAgainIsAFreshBuild)
{
    const Media media = clouds_with({0.6f, 0.0f, 0.0f}, Phase{});
    EnvironmentCache moved = make_cache(media, sunny_sky());
    const Vec3 x(0.1f, 0.0f, 0.2f);
    const Spectrum before = moved.inscatter(0, x);
    const Vec3 there(4.0f, 0.0f, 0.0f);
    moved.bake(there);
    EXPECT_NE(moved.inscatter(0, x), before);
    const EnvironmentCache fresh = make_cache(media, sunny_sky(), {4, 8}, there);
    EXPECT_EQ(moved.inscatter(0, x), fresh.inscatter(0, x));
    const Vec3 wi = glm::normalize(Vec3(1.0f, 2.0f, 3.0f));
    EXPECT_EQ(moved.directional(0, x, wi, wi), fresh.directional(0, x, wi, wi));
}

TEST(EnvironmentCache, DefinedForEmptyMediaAndStrangePoints)
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Vec3 up(0.0f, 1.0f, 0.0f);
    EXPECT_EQ(EnvironmentCache().inscatter(0, up), Spectrum(0.0f));
    EXPECT_EQ(EnvironmentCache().directional(0, up, up, up), Spectrum(0.0f));
    Media empty;
    Volume nothing = test::cube_volume(9, 2.0f, [](Vec3) { return 0.0f; });
    nothing.phase.g = 0.95f;
    empty.volumes.push_back(nothing);
    Media opaque = clouds_with({0.95f, 0.0f, 0.0f}, Phase{});
    opaque.volumes[0].density_scale = 1e20f;
    for (const Media& media : {empty, opaque}) {
        for (const Vec3& eye : {camera, Vec3(0.0f), Vec3(1e20f), Vec3(nan)}) {
            const EnvironmentCache cache = make_cache(media, sunny_sky(), {4, 8}, eye);
            for (const float bad : {0.0f, nan, infinity, -infinity, 1e30f}) {
                const Spectrum S = cache.inscatter(0, Vec3(bad, 0.0f, bad));
                const Spectrum f = cache.directional(0, Vec3(0.0f, bad, 0.0f), up, Vec3(bad));
                EXPECT_TRUE(is_finite(S) && std::min({S.x, S.y, S.z}) >= 0.0f) << bad;
                EXPECT_TRUE(is_finite(f) && std::min({f.x, f.y, f.z}) >= 0.0f) << bad;
            }
        }
    }
}

TEST(EnvironmentCache, CameraOnANodeStaysFinite)
{
    const Media media = clouds_with({0.95f, 0.0f, 0.0f}, Phase{});
    const auto cached = transmittances(media);
    const SmokeLattice& lattice = cached->lattice();
    const Vec3 eye = lattice.position(lattice.nodes[lattice.nodes.size() / 2]);
    const EnvironmentCache cache(cached, mean_radiance(constant_sky(), cached->hats()), media, eye);
    const Vec3d sum =
        integral_over_lobes(cache, media.volumes[0].phase, eye, Vec3(0.0f, 0.0f, 1.0f), 8, 480);
    const Vec3d exact(cache.inscatter(0, eye));
    EXPECT_TRUE(is_finite(Vec3(exact)));
    EXPECT_LT(glm::length(sum - exact), 1e-5 * glm::length(exact));
}

TEST(EnvironmentCache, DoesNotDependOnTheThreadCount)
{
    const Media media = clouds_with({0.6f, 0.0f, 0.0f}, Phase{});
    const auto values = [&](int threads) {
        std::vector<Spectrum> out;
        run_with_threads(threads, [&] {
            const EnvironmentCache cache = make_cache(media, sunny_sky());
            for (uint32_t i = 0; i < 300; ++i) {
                Rng rng(4, 0, Stream::Test, i, 0);
                const Vec3 x = Vec3(-1.0f) + 2.0f * rng.uniform3();
                out.push_back(cache.inscatter(0, x));
                out.push_back(
                    cache.directional(0, x, Vec3(1.0f, 0.0f, 0.0f), sample_sphere(rng.uniform2())));
            }
        });
        return out;
    };
    const std::vector<Spectrum> one = values(1);
    for (const int threads : {2, 5}) EXPECT_EQ(values(threads), one);
}

TEST(MediaKey, TellsWhetherTransmittancesAreStillRight)
{
    const Media media = two_clouds();
    EXPECT_TRUE(media_key(media) == media_key(media));
    Media recoloured = media;
    recoloured.volumes[0].albedo = Spectrum(0.2f);
    EXPECT_TRUE(media_key(media) == media_key(recoloured));
    Media denser = media;
    denser.volumes[1].density_scale *= 2.0f;
    EXPECT_FALSE(media_key(media) == media_key(denser));
    Media moved = media;
    moved.volumes[0].world_from_object.keys[0].translate.x += 1e-6;
    EXPECT_FALSE(media_key(media) == media_key(moved));
    EXPECT_FALSE(media_key(media) == media_key(two_clouds()));  // other grids
    EXPECT_FALSE(media_key(media) == media_key(Media{}));
}

}  // namespace
}  // namespace mote
