// What vertices share, against paths of each vertex's own; and wrong ways to share, which the same
// test must find out.

#include <gtest/gtest.h>

#include "multiscatter/gather_light.h"
#include "multiscatter/send_paths.h"
#include "multiscatter/sharing.h"
#include "restir/room_scenes.h"

namespace mote {
namespace {

using test::cloud;
using test::compare_with_alone;
using test::Sharing;

constexpr double alarm = 1e-5;  // false alarms, each comparison

enum class Mistake {
    None,
    NoJacobian,      ///< distances to the second vertex are left out
    OnlyWhatLanded,  ///< paths that find nothing do not count
    NoCheck,         ///< assumed transmittances are taken for true ones
    StaleLight,      ///< the second vertices' light goes on as it went to the vertex before
    OneEventTooMany  ///< light that the first vertices' own rays meet counts too
};

/// One level of it, open to mistakes.
Spectrum shared_with(const Sharing& setting, Mistake mistake, Rng& rng)
{
    const std::vector<PathVertex>& first = setting.first;
    WalkCounts counts;
    float cut = 0.0f;
    const TraceContext context = setting.trace();
    const SharingContext sharing{context, setting.extinction, 64, cache_time, counts, cut};
    PathLevel level;
    PathLevel next;
    level.vertices = first;
    send_paths(sharing, 1, mistake != Mistake::OneEventTooMany, level, next, rng);
    Spectrum extra(0.0f);
    for (const PathVertex& v : level.vertices) {
        for (int a = 0; a < v.arrival_count; ++a) {
            extra += v.weight * eval_phase(*v.phase, v.wo, v.arrivals[a].wi) * v.arrivals[a].E;
        }
    }
    const size_t width = level.kernels.size() / std::max<size_t>(next.vertices.size(), 1);
    for (size_t j = 0; j < next.vertices.size(); ++j) {
        PathVertex& y = next.vertices[j];
        follow_own_path(sharing, next.event(y, cache_time), 2, y, rng);
        if (mistake == Mistake::NoCheck) y.log_excess = 0.0f;
        const Vec3 x = first[static_cast<size_t>(y.from)].x;
        for (size_t i = 0; i < first.size(); ++i) {
            float& kernel = level.kernels[j * width + static_cast<size_t>(i)];
            const float d = glm::length(y.x - first[static_cast<size_t>(level.order[i])].x);
            const float own = glm::length(y.x - x);
            if (mistake == Mistake::NoJacobian) kernel *= d * d / (own * own);
            if (mistake == Mistake::OnlyWhatLanded) {
                kernel *=
                    static_cast<float>(first.size()) / static_cast<float>(next.vertices.size());
            }
            if (mistake == Mistake::StaleLight) {
                kernel *=
                    phase_pdf(*y.phase, glm::normalize(x - y.x), Vec3(0, 1, 0)) /
                    phase_pdf(*y.phase,
                              glm::normalize(first[static_cast<size_t>(level.order[i])].x - y.x),
                              Vec3(0, 1, 0));
            }
        }
    }
    std::vector<Spectrum> light(1, Spectrum(0.0f));
    gather_light(sharing, level, next, rng, light);
    return light[0] + extra;
}

TEST(PathSharingStat, VerticesGetWhatTheirOwnPathsBring)
{
    for (const float spread : {0.05f, 0.7f}) {
        for (const float g : {-0.4f, 0.0f, 0.85f}) {
            for (const int levels : {1, 2, 5}) {
                const Sharing sharing(cloud(8.0f, g), 4, spread);
                const TestResult result = compare_with_alone(sharing, {32, 60}, [&](Rng& rng) {
                    return sharing.shared({.group_size = 4, .levels = levels}, rng);
                });
                EXPECT_GT(result.p, alarm) << spread << ' ' << g << ' ' << levels;
            }
        }
    }
}

TEST(PathSharingStat, SurfacesMayBeMetOnTheWay)
{
    Scene scene = test::room();
    const Sharing sharing(std::move(scene), 4, 0.3f);
    const TestResult result = compare_with_alone(sharing, {32, 100}, [&](Rng& rng) {
        return sharing.shared({.group_size = 8, .levels = 2}, rng);
    });
    EXPECT_GT(result.p, alarm);
}

TEST(PathSharingStat, WrongWaysAreFoundOut)
{
    const Sharing sharing(cloud(8.0f, 0.6f), 3, 0.5f);
    const test::Batches batches{32, 400};
    const auto judge = [&](Mistake mistake) {
        return compare_with_alone(sharing, batches,
                                  [&](Rng& rng) { return shared_with(sharing, mistake, rng); })
            .p;
    };
    EXPECT_GT(judge(Mistake::None), alarm);
    EXPECT_LT(judge(Mistake::NoJacobian), alarm);
    EXPECT_LT(judge(Mistake::OnlyWhatLanded), alarm);
    EXPECT_LT(judge(Mistake::NoCheck), alarm);
    EXPECT_LT(judge(Mistake::StaleLight), alarm);
    EXPECT_LT(judge(Mistake::OneEventTooMany), alarm);
}

/// What sharing is for: one vertex's light has less noise than its own path's. Groups of one are
/// the negative control.
TEST(PathSharingStat, SharedLightHasLessNoise)
{
    Sharing sharing(cloud(8.0f, 0.3f), 100, 0.1f);
    const std::vector<PathVertex> few = sharing.first;
    sharing.first.clear();
    for (size_t i = 0; i < 48; ++i) {
        PathVertex v = few[i % few.size()];
        v.x += 1e-3f * Vec3(static_cast<float>(i));
        v.from = i == 0 ? 0 : 1;
        v.weight = Spectrum(1.0f);
        sharing.first.push_back(v);
    }
    const auto noise = [&](int group_size) {
        RunningStats stats;
        for (uint32_t i = 0; i < 300; ++i) {
            Rng rng(1, i, Stream::Test, 0, 0);
            std::vector<Spectrum> light(2, Spectrum(0.0f));
            WalkCounts counts;
            float cut = 0.0f;
            share_paths(sharing.trace(), sharing.extinction, {.group_size = group_size},
                        sharing.first, rng, light, counts, cut);
            stats.add(static_cast<double>(luminance(light[0])));
        }
        return estimate_mean(stats).standard_error();
    };
    const double alone = noise(1);
    EXPECT_LT(noise(64), 0.6 * alone);
    EXPECT_GT(noise(2), 0.6 * alone);
}

TEST(PathSharing, NothingComesFromNothing)
{
    const Sharing sharing(cloud(8.0f, 0.3f), 4, 0.3f);
    std::vector<PathVertex> black = sharing.first;
    for (PathVertex& v : black) v.weight = Spectrum(0.0f);
    std::vector<Spectrum> light(1, Spectrum(0.0f));
    WalkCounts counts;
    float cut = 0.0f;
    Rng rng(1, 0, Stream::Test, 0, 0);
    share_paths(sharing.trace(), sharing.extinction, {}, black, rng, light, counts, cut);
    share_paths(sharing.trace(), sharing.extinction, {}, {}, rng, light, counts, cut);
    EXPECT_EQ(light[0], Spectrum(0.0f));
    EXPECT_EQ(cut, 0.0f);
}

}  // namespace
}  // namespace mote
