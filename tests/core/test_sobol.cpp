#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "core/sobol.h"
#include "support/chi_squared.h"
#include "support/trials.h"

namespace mote {
namespace {

using test::chi_squared_z;

/// Index of the cell of an nx x ny grid over the unit square.
size_t cell_of(Vec2 u, uint32_t nx, uint32_t ny)
{
    const auto x = static_cast<size_t>(u.x * static_cast<float>(nx));
    const auto y = static_cast<size_t>(u.y * static_cast<float>(ny));
    return y * nx + x;
}

/// Points that share a cell with another, over all elementary intervals of 2^n cells.
int crowded_cells(const std::vector<Vec2>& points, uint32_t n)
{
    int crowded = 0;
    for (uint32_t nx = 0; nx <= n; ++nx) {
        std::set<size_t> taken;
        for (const Vec2& p : points) taken.insert(cell_of(p, 1u << nx, 1u << (n - nx)));
        crowded += static_cast<int>(points.size() - taken.size());
    }
    return crowded;
}

TEST(Sobol, BitsAreReversed)
{
    EXPECT_EQ(reverse_bits(1u), 0x80000000u);
    EXPECT_EQ(reverse_bits(0x00f0000au), 0x50000f00u);
    for (uint32_t v = 1; v != 0; v <<= 1u) EXPECT_EQ(reverse_bits(reverse_bits(v)), v);
}

TEST(Sobol, UnscrambledPointsAreSobols)
{
    // The first points of dimensions 1 and 2 as in Joe and Kuo's tables, without the Gray code.
    const float x[] = {0.0f, 0.5f, 0.25f, 0.75f, 0.125f, 0.625f, 0.375f, 0.875f};
    const float y[] = {0.0f, 0.5f, 0.75f, 0.25f, 0.625f, 0.125f, 0.375f, 0.875f};
    for (uint32_t i = 0; i < 8; ++i) {
        EXPECT_EQ(to_unit_float(sobol_x(i)), x[i]) << i;
        EXPECT_EQ(to_unit_float(sobol_y(i)), y[i]) << i;
    }
}

TEST(Sobol, OwenScramblingKeepsPrefixesApart)
{
    // A scrambled bit depends on the higher bits alone: numbers that agree in their first k bits
    // agree there afterwards, and those that differ first at bit k still do.
    Rng rng(1, 0, Stream::Test, 0, 0);
    for (int i = 0; i < 2000; ++i) {
        const uint32_t seed = rng.next();
        const uint32_t a = rng.next();
        const uint32_t k = rng.next() & 31u;
        const uint32_t b = (a ^ (0x80000000u >> k)) ^ (k < 31u ? rng.next() >> (k + 1u) : 0u);
        const uint32_t difference = owen_scramble(a, seed) ^ owen_scramble(b, seed);
        EXPECT_EQ(difference >> (31u - k), 1u) << k;
    }
}

TEST(PassSequence, FirstPassesFillEveryElementaryInterval)
{
    // (0,n,2)-nets in base 2: of the first 2^n passes one falls into each cell of every grid of
    // 2^n equal cells, for any key and pair. Exact, not statistical. The same holds for every
    // later run of 2^n passes that starts at a multiple of 2^n.
    for (uint32_t key = 0; key < 20; ++key) {
        for (const uint32_t pair : {0u, 1u, 5u}) {
            for (const uint32_t n : {1u, 2u, 3u, 4u, 6u, 8u}) {
                for (const uint32_t first : {0u, 3u << n}) {
                    std::vector<Vec2> points;
                    for (uint32_t i = 0; i < 1u << n; ++i) {
                        points.push_back(PassSequence(hash32(key), first + i).pair(pair));
                    }
                    EXPECT_EQ(crowded_cells(points, n), 0) << key << " " << pair << " " << n;
                }
            }
        }
    }
}

TEST(PassSequence, IndependentNumbersAreCrowded)
{
    // Negative control of the test above: of 16 independent points some share a cell.
    std::vector<Vec2> points;
    Rng rng(1, 0, Stream::Test, 0, 0);
    for (int i = 0; i < 16; ++i) points.push_back(rng.uniform2());
    EXPECT_GT(crowded_cells(points, 4), 10);
}

/// z of the counts of f(key) in [0, 1)^2 over a 16 x 16 grid.
template <class F>
double uniformity_z(F&& f)
{
    constexpr uint32_t edge = 16;
    constexpr uint32_t count = 40'000;
    std::vector<double> observed(edge * edge, 0.0);
    const std::vector<double> expected(edge * edge, static_cast<double>(count) / (edge * edge));
    for (uint32_t key = 0; key < count; ++key) observed[cell_of(f(key), edge, edge)] += 1.0;
    return chi_squared_z(observed, expected);
}

TEST(PassSequenceStat, OnePassIsUniform)
{
    // Over keys, as pixels of one pass see it; keys made as the camera pass makes them. |z| > 5:
    // false alarm once in 100,000 seeds for all together.
    for (const uint32_t pass : {0u, 1u, 2u, 7u, 63u, 1000u, 123'456u}) {
        for (const uint32_t pair : {0u, 3u}) {
            const double z = uniformity_z([&](uint32_t key) {
                return PassSequence(hash_combine(hash32(17), key), pass).pair(pair);
            });
            EXPECT_LT(std::abs(z), 5.0) << pass << " " << pair;
        }
    }
}

TEST(PassSequenceStat, PairsAndPixelsAreIndependent)
{
    // Joint distribution of numbers that must know nothing of each other.
    const auto at = [](uint32_t key, uint32_t pass, uint32_t pair) {
        return PassSequence(hash_combine(hash32(5), key), pass).pair(pair);
    };
    for (const uint32_t pass : {0u, 1u, 30u}) {
        const auto expect_independent = [&](const char* what, auto&& f) {
            EXPECT_LT(std::abs(uniformity_z(f)), 5.0) << what << ", pass " << pass;
        };
        expect_independent("x of two pairs", [&](uint32_t key) {
            return Vec2(at(key, pass, 0).x, at(key, pass, 1).x);
        });
        expect_independent("y of two pairs", [&](uint32_t key) {
            return Vec2(at(key, pass, 2).y, at(key, pass, 4).y);
        });
        expect_independent("x and y of two pairs", [&](uint32_t key) {
            return Vec2(at(key, pass, 3).x, at(key, pass, 2).y);
        });
        expect_independent("neighbouring pixels", [&](uint32_t key) {
            return Vec2(at(2 * key, pass, 0).x, at(2 * key + 1, pass, 0).x);
        });
        expect_independent("neighbouring pixels, other axis", [&](uint32_t key) {
            return Vec2(at(2 * key, pass, 0).y, at(2 * key + 1, pass, 0).y);
        });
    }
}

TEST(PassSequenceStat, StratificationPays)
{
    // Mean over 64 passes of x y: independent numbers have variance (1/9 - 1/16) / 64.
    RunningStats means;
    for (uint32_t key = 0; key < 2000; ++key) {
        double sum = 0.0;
        for (uint32_t pass = 0; pass < 64; ++pass) {
            const Vec2 u = PassSequence(hash_combine(hash32(9), key), pass).pair(1);
            sum += static_cast<double>(u.x) * static_cast<double>(u.y);
        }
        means.add(sum / 64.0);
    }
    // Unbiased: 5 standard errors, false once in 1.7 million seeds.
    EXPECT_LT(std::abs(means.mean - 0.25), 5.0 * means.standard_error());
    EXPECT_LT(50.0 * means.variance(), (1.0 / 9.0 - 1.0 / 16.0) / 64.0);
}

}  // namespace
}  // namespace mote
