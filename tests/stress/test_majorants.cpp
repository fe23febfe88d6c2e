// Majorants bound densities of any range: no tracker ever meets more than it was told.
#include <gtest/gtest.h>

#include "stress/stress_scenes.h"
#include "support/trials.h"

namespace mote {
namespace {

/// 18^3 voxels of 1/8 m whose values spread over 10^decades below `top`.
Volume spread(float top, float decades)
{
    std::vector<float> values(18 * 18 * 18);
    for (uint32_t i = 0; i < values.size(); ++i) {
        Rng rng(8, 0, Stream::Test, i, 0);
        values[i] = top * std::pow(10.0f, -decades * rng.uniform());
    }
    Volume volume;
    volume.density = make_dense_bricks(Vec3i(18), values, {Mat3(8.0f), Vec3(9.0f)});
    finalize(volume);
    return volume;
}

TEST(StressMajorants, NoDensityPassesItsBricksMajorant)
{
    // The last bits of an interpolation are rounding: 4 units in the last place.
    for (const float decades : {0.0f, 1e-6f, 1.0f, 30.0f}) {
        for (const float top : {1e-30f, 1.0f, 1e30f}) {
            const Volume volume = spread(top, decades);
            const BrickGrid& grid = *volume.density;
            for (uint32_t i = 0; i < 20'000; ++i) {
                Rng rng(9, 0, Stream::Test, i, 0);
                const Vec3 p = rng.uniform3() * Vec3(grid.brick_count * BrickGrid::brick_size);
                const Vec3i at = Vec3i(p) / BrickGrid::brick_size;
                const int brick = std::max(grid.table[grid.table_index(at.x, at.y, at.z)], 0);
                const float bound = grid.ranges[static_cast<size_t>(brick)].max;
                ASSERT_LE(sample_local(grid, p), bound * (1.0f + 4 * 0x1p-23f)) << top;
            }
        }
    }
}

TEST(StressMajorantsStat, TransmittancesStayInRangeAndKeepTheirMean)
{
    // 5 standard errors, once in 1.7 million seeds each; 1e-5 for the exact depth's own rounding.
    // Residual ratio tracking may pass 1 on the way: its control is the mean of a brick.
    for (const float decades : {0.0f, 1e-6f, 1.0f, 30.0f}) {
        for (const float tau : {1e-6f, 1.0f, 8.0f}) {
            Media media{{spread(1.0f, decades)}};
            const Ray ray{{-3.0f, 0.11f, 0.07f}, {1.0f, 0.0f, 0.0f}, 0.0f};
            const Interval all{0.0f, infinity};
            media.volumes[0].density_scale = tau / optical_depth(media, ray, all);
            const double exact = std::exp(-static_cast<double>(tau));
            for (const TransmittanceKind kind :
                 {TransmittanceKind::Ratio, TransmittanceKind::ResidualRatio,
                  TransmittanceKind::Exact}) {
                const float most = kind == TransmittanceKind::ResidualRatio ? infinity : 1.0f;
                const RunningStats stats = test::run_trials(20'000, 3, [&](Rng& rng) {
                    const float T = estimate_transmittance(media, ray, all, kind, rng);
                    EXPECT_TRUE(T >= 0.0f && T <= most && std::isfinite(T)) << T;
                    return T;
                });
                EXPECT_NEAR(stats.mean, exact, 5.0 * stats.standard_error() + 1e-5 * exact)
                    << decades << " " << tau << " " << static_cast<int>(kind);
            }
        }
    }
}

}  // namespace
}  // namespace mote
