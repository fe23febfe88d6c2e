#include <gtest/gtest.h>

#include "core/sampling.h"
#include "restir/direction_hats.h"
#include "scene/environment.h"

namespace mote {
namespace {

const DirectionHats shapes[] = {{6, 12}, {4, 8}, {5, 7}, {1, 1}, {1, 3}, {3, 1}, {2, 2}};

float value_at(const DirectionHats& hats, int k, Vec3 wi)
{
    const DirectionHats::Weights at = hats.at(wi);
    float sum = 0.0f;
    for (int e = 0; e < 4; ++e) sum += at.index[e] == k ? at.weight[e] : 0.0f;
    return sum;
}

/// Direction at height 1 - 2u and azimuth 2 pi v.
Vec3 direction(double u, double v)
{
    const double y = 1.0 - 2.0 * u;
    const double r = std::sqrt(std::max(0.0, 1.0 - y * y));
    return {r * std::sin(2.0 * std::numbers::pi * v), y, r * std::cos(2.0 * std::numbers::pi * v)};
}

TEST(DirectionHats, AreOneAtTheirCentreAndSumToOne)
{
    for (const DirectionHats& hats : shapes) {
        for (int k = 0; k < hats.count(); ++k) {
            EXPECT_NEAR(glm::length(hats.centre(k)), 1.0f, 1e-6f);
            EXPECT_NEAR(value_at(hats, k, hats.centre(k)), 1.0f, 1e-5f);
        }
        for (uint32_t i = 0; i < 1000; ++i) {
            Rng rng(1, 0, Stream::Test, i, 0);
            const DirectionHats::Weights at = hats.at(sample_sphere(rng.uniform2()));
            float sum = 0.0f;
            for (int e = 0; e < 4; ++e) {
                ASSERT_TRUE(at.index[e] >= 0 && at.index[e] < hats.count());
                ASSERT_TRUE(at.weight[e] >= 0.0f && at.weight[e] <= 1.0f);
                sum += at.weight[e];
            }
            EXPECT_NEAR(sum, 1.0f, 1e-6f);
        }
    }
}

TEST(DirectionHats, AllCoverTheSameSolidAngle)
{
    // Bilinear between lines at half areas, so the midpoint rule is exact on a grid that has them.
    for (const DirectionHats& hats : shapes) {
        const int rows = 8 * hats.bands;
        const int columns = 8 * hats.azimuths;
        std::vector<double> sum(static_cast<size_t>(hats.count()), 0.0);
        for (int i = 0; i < rows; ++i) {
            for (int j = 0; j < columns; ++j) {
                const auto at = hats.at(direction((i + 0.5) / rows, (j + 0.5) / columns));
                for (int e = 0; e < 4; ++e) {
                    sum[static_cast<size_t>(at.index[e])] += static_cast<double>(at.weight[e]);
                }
            }
        }
        for (const double s : sum) {
            EXPECT_NEAR(4.0 * std::numbers::pi * s / (rows * columns), hats.solid_angle(),
                        1e-5 * static_cast<double>(hats.solid_angle()));
        }
    }
}

TEST(DirectionHats, OppositeAreasLieOpposite)
{
    for (const DirectionHats& hats : shapes) {
        for (int k = 0; k < hats.count(); ++k) {
            const int opposite = hats.opposite(k);
            EXPECT_EQ(opposite < 0, hats.azimuths % 2 != 0);
            if (opposite < 0) continue;
            EXPECT_EQ(hats.opposite(opposite), k);
            EXPECT_LT(glm::length(hats.centre(k) + hats.centre(opposite)), 1e-6f);
        }
    }
}

TEST(DirectionHats, ContinuousOverSeamAndPoles)
{
    const DirectionHats hats{6, 12};
    for (int k = 0; k < hats.count(); ++k) {
        for (const double v : {0.0, 0.5, 0.999999999}) {
            for (const double u : {0.0, 0.3, 0.5, 1.0}) {
                EXPECT_NEAR(value_at(hats, k, direction(u, v)),
                            value_at(hats, k, direction(u, v + 1e-7)), 1e-4f);
            }
        }
    }
}

TEST(DirectionHats, AnyVectorGivesValidHats)
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const DirectionHats& hats : shapes) {
        for (const float a : {nan, infinity, -infinity, 0.0f, 1e30f}) {
            for (const float b : {nan, infinity, -infinity, 0.0f, -1e30f}) {
                const DirectionHats::Weights at = hats.at(Vec3(a, b, a));
                for (int e = 0; e < 4; ++e) {
                    EXPECT_TRUE(at.index[e] >= 0 && at.index[e] < hats.count());
                    EXPECT_TRUE(at.weight[e] >= 0.0f && at.weight[e] <= 1.0f);
                }
            }
        }
    }
}

TEST(MeanRadiance, ConstantEnvironmentIsItself)
{
    const EnvironmentLight constant{Spectrum(0.1f, 0.7f, 2.0f), nullptr, Mat3(1.0f)};
    for (const Spectrum& L : mean_radiance(constant, DirectionHats{})) {
        EXPECT_EQ(L, constant.radiance);
    }
    // A constant image is no different, whatever its size and rotation.
    for (const auto& [width, height] : {std::pair{1, 1}, {7, 3}, {600, 300}}) {
        EnvironmentLight image = constant;
        image.map = make_environment_map(Buffer2D<Spectrum>(width, height, Spectrum(1.0f)), "test");
        image.map_from_world = make_frame(glm::normalize(Vec3(1.0f, 2.0f, -3.0f)));
        for (const Spectrum& L : mean_radiance(image, DirectionHats{})) {
            EXPECT_LT(glm::length(L - constant.radiance), 1e-5f);
        }
    }
}

TEST(MeanRadiance, SumsToTheFluenceAndPutsASunInItsPlace)
{
    Buffer2D<Spectrum> pixels(128, 64, Spectrum(0.2f, 0.3f, 0.5f));
    pixels.at(100, 14) = Spectrum(3000.0f);
    EnvironmentLight light{Spectrum(2.0f), make_environment_map(std::move(pixels), "test"),
                           make_frame(glm::normalize(Vec3(1.0f, 2.0f, -3.0f)))};
    const DirectionHats hats{6, 12};
    const std::vector<Spectrum> radiance = mean_radiance(light, hats);
    double fluence = 0.0;
    int brightest = 0;
    for (int k = 0; k < hats.count(); ++k) {
        const Spectrum& L = radiance[static_cast<size_t>(k)];
        fluence += static_cast<double>(hats.solid_angle() * luminance(L));
        if (L.y > radiance[static_cast<size_t>(brightest)].y) brightest = k;
    }
    // Measured: 2e-3 apart. Each side treats solid angles inside pixels in its own way.
    const double exact = static_cast<double>(environment_fluence(light));
    EXPECT_NEAR(fluence, exact, 5e-3 * exact);
    // Direction of the pixel's centre, by the image's convention.
    const float phi = 2.0f * pi * (100.5f / 128.0f - 0.5f);
    const float theta = pi * 14.5f / 64.0f;
    const Vec3 d(std::sin(theta) * std::sin(phi), std::cos(theta),
                 -std::sin(theta) * std::cos(phi));
    const Vec3 sun = d * light.map_from_world;
    EXPECT_GT(luminance(environment_radiance(light, sun)), 5000.0f);
    const DirectionHats::Weights at = hats.at(sun);
    const auto nearest = std::max_element(at.weight, at.weight + 4) - at.weight;
    EXPECT_EQ(brightest, at.index[nearest]);
}

}  // namespace
}  // namespace mote
