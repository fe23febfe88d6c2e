// Paths of many events in other pixels: what they bring there, Jacobians, and the way back.

#include "multiscatter/shift_path.h"

#include <gtest/gtest.h>

#include "multiscatter/path_worlds.h"
#include "restir/reuse_scenes.h"

namespace mote {
namespace {

constexpr ShiftKind kinds[] = {ShiftKind::RandomNumbers, ShiftKind::World, ShiftKind::Fraction};

using Frames = std::vector<std::unique_ptr<test::PathScene>>;

/// Smoke of wide lobes, and smoke of narrow ones, of which paths are walked again.
const Frames& wide_frames()
{
    static const Frames made = test::path_scenes(test::everything_moves_frames(2), 6);
    return made;
}
const Frames& narrow_frames()
{
    static const Frames made = [] {
        std::vector<Scene> scenes = test::everything_moves_frames(2);
        for (Scene& scene : scenes) scene.media.volumes[0].phase = {0.9f};
        return test::path_scenes(scenes, 6);
    }();
    return made;
}

/// Two rays a pixel apart, in time or in space, and a map between them.
struct Pair {
    const test::PathScene* from_scene = nullptr;
    const test::PathScene* to_scene = nullptr;
    PathWorld from_world;
    PathWorld to_world;
    PixelDomain from, to;
    PathMap map;

    Pair(const test::PathScene& a, const test::PathScene& b)
        : from_scene(&a), to_scene(&b), from_world(a.world()), to_world(b.world())
    {
    }
    [[nodiscard]] PathEndpoint from_end() const { return {from_world, from}; }
    [[nodiscard]] PathEndpoint to_end() const { return {to_world, to}; }
};

Pair random_pair(const Frames& frames, ShiftKind kind, Rng& rng)
{
    const bool in_time = rng.uniform() < 0.5f;
    Pair pair(*frames[in_time ? 0 : 1], *frames[1]);
    const Vec2 film = Vec2(2.0f) + Vec2(4.0f, 2.0f) * rng.uniform2();
    pair.to_scene->make_domain(film, pair.to);
    pair.from_scene->make_domain(film + 2.0f * rng.uniform2() - 1.0f, pair.from);
    const Vec3 motion = in_time ? 0.1f * (rng.uniform3() - 0.5f) : Vec3(0.0f);
    pair.map = {kind, make_ray_map(pair.from.ray, pair.to.ray, motion), motion,
                in_time ? SuffixRule::Traced : SuffixRule::Kept};
    return pair;
}

/// A path of the pair's first pixel; empty if the walk finds nothing.
std::optional<DrawnPath> random_path(const Pair& pair, uint32_t trial, Rng& rng)
{
    std::vector<DrawnPath> paths;
    float cut = 0.0f;
    const auto frame = static_cast<uint32_t>(pair.from_world.frame.scene->frame);
    draw_paths(pair.from_world, pair.from, rng.uniform(), {frame, trial, 0}, paths, cut);
    if (paths.empty()) return std::nullopt;
    return paths[rng.next() % paths.size()];
}

/// Light over density, as drawn, and light itself differ by the density.
TEST(ReusedPaths, BringWhatTheyWereDrawnWith)
{
    int compared = 0;
    for (uint32_t trial = 0; trial < 2000; ++trial) {
        Rng rng(1, 0, Stream::Test, trial, 0);
        const Pair pair = random_pair(wide_frames(), ShiftKind::World, rng);
        const std::optional<DrawnPath> path = random_path(pair, trial, rng);
        if (!path) continue;
        const Spectrum f = eval_path(pair.from_world, pair.from, path->y);
        if (path->y.form == PathForm::Replay) {
            EXPECT_EQ(f, path->value);
            continue;
        }
        const Media& media = pair.from_world.media();
        const Vec3 x1 = point_at(pair.from_world.frame, pair.from, path->y.u).x;
        const Vec3 w1 = glm::normalize(path->y.x2 - x1);
        const float T = std::exp(-optical_depth(media, Ray{x1, w1, 0.0f}, {0.0f, path->y.r}));
        const Phase& phase = media.volumes[0].phase;
        float density =
            eval_phase(phase, pair.from.wo(), w1) * T * sigma_t_at(media, path->y.x2, 0.0f);
        if (path->y.form == PathForm::ToRay) density *= eval_phase(phase, -w1, path->y.wi);
        // Rounding of directions, through lobes, and of optical depths.
        EXPECT_NEAR(luminance(f), density * luminance(path->value), 2e-3f * luminance(f));
        ++compared;
    }
    EXPECT_GT(compared, 500);
}

/// First vertex, direction and distance as four numbers, the direction near a given one.
struct PathNumbers {
    float of[4]{};
};

PathNumbers numbers_of(const PathEndpoint& end, const ReusedPath& y, const Mat3& frame)
{
    const Vec3 x1 = point_at(end.world.frame, end.domain, y.u).x;
    const Vec3 way = glm::transpose(frame) * (y.x2 - x1);
    return {{y.u, way.x / way.z, way.y / way.z, glm::length(way)}};
}

ReusedPath path_of(const PathEndpoint& end, ReusedPath y, const PathNumbers& n, const Mat3& frame)
{
    y.u = n.of[0];
    y.r = n.of[3];
    const Vec3 x1 = point_at(end.world.frame, end.domain, y.u).x;
    y.x2 = x1 + y.r * glm::normalize(frame * Vec3(n.of[1], n.of[2], 1.0f));
    return y;
}

Mat3 frame_of(const PathEndpoint& end, const ReusedPath& y)
{
    const Vec3 x1 = point_at(end.world.frame, end.domain, y.u).x;
    return make_frame(glm::normalize(y.x2 - x1));
}

/// Determinant of d(u', w1', r') / d(u, w1, r) by central differences. Floats: points are good to
/// 1e-6 over steps of 4e-3 r; kinks where the steps cross cell borders, told by a tenth of them.
TEST(ReusedPaths, ReconnectionHasTheJacobianOfTheDerivative)
{
    for (const ShiftKind kind : kinds) {
        int compared = 0;
        int off = 0;
        double largest_change = 0.0;
        for (uint32_t trial = 0; trial < 3000; ++trial) {
            Rng rng(2, 0, Stream::Test, trial, 0);
            Pair pair = random_pair(wide_frames(), kind, rng);
            pair.map.suffix = SuffixRule::Kept;  // is no part of the measure
            const std::optional<DrawnPath> path = random_path(pair, trial, rng);
            if (!path || path->y.form == PathForm::Replay) continue;
            const auto there = shift_path(path->y, pair.from_end(), pair.to_end(), pair.map);
            if (!there) continue;
            const Mat3 frame = frame_of(pair.from_end(), path->y);
            const Mat3 frame_there = frame_of(pair.to_end(), there->y);
            const PathNumbers at = numbers_of(pair.from_end(), path->y, frame);
            const float steps[4] = {1e-3f, 4e-3f, 4e-3f, 4e-3f * path->y.r};
            glm::dmat4 derivative(0.0);
            bool complete = true;
            for (int i = 0; i < 4 && complete; ++i) {
                PathNumbers moved[2] = {at, at};
                moved[0].of[i] -= steps[i];
                moved[1].of[i] += steps[i];
                PathNumbers after[2];
                for (int side = 0; side < 2; ++side) {
                    const ReusedPath y = path_of(pair.from_end(), path->y, moved[side], frame);
                    const auto shifted = shift_path(y, pair.from_end(), pair.to_end(), pair.map);
                    complete = complete && shifted;
                    if (shifted) after[side] = numbers_of(pair.to_end(), shifted->y, frame_there);
                }
                for (int j = 0; j < 4; ++j) {
                    derivative[i][j] = static_cast<double>(after[1].of[j] - after[0].of[j]) /
                                       static_cast<double>(2.0f * steps[i]);
                }
            }
            if (!complete) continue;
            const double slope = std::abs(glm::determinant(derivative));
            const auto jacobian = static_cast<double>(there->jacobian);
            ++compared;
            if (std::abs(slope - jacobian) > 0.05 * jacobian) ++off;
            largest_change = std::max(largest_change, std::abs(std::log(jacobian)));
        }
        EXPECT_GT(compared, 200) << static_cast<int>(kind);
        EXPECT_LE(off, compared / 10) << static_cast<int>(kind);
        EXPECT_GT(largest_change, 0.5);  // a missing Jacobian would show
    }
}

/// There and back is where one was, Jacobians cancel, and the path brings the same light.
void expect_round_trips(const Frames& frames, PathForm expected)
{
    for (const ShiftKind kind : kinds) {
        int defined = 0;
        int one_way = 0;
        int off = 0;
        int of_form = 0;
        for (uint32_t trial = 0; trial < 3000; ++trial) {
            Rng rng(3, 0, Stream::Test, trial, 0);
            const Pair pair = random_pair(frames, kind, rng);
            const std::optional<DrawnPath> path = random_path(pair, trial, rng);
            if (!path) continue;
            const auto there = shift_path(path->y, pair.from_end(), pair.to_end(), pair.map);
            if (!there) continue;
            ++defined;
            of_form += there->y.form == expected ? 1 : 0;
            EXPECT_EQ(there->y.form, path->y.form);
            const auto back =
                shift_path(there->y, pair.to_end(), pair.from_end(), pair.map.inverse());
            if (!back) {
                ++one_way;
                continue;
            }
            const Spectrum f = eval_path(pair.from_world, pair.from, path->y);
            const bool is_same =
                std::abs(back->y.u - path->y.u) < 4e-5f + 2e-6f / there->jacobian &&
                std::abs(back->jacobian * there->jacobian - 1.0f) < 0.01f &&
                (path->y.form == PathForm::Replay ||
                 glm::length(back->y.x2 - path->y.x2) < 1e-5f) &&
                std::abs(luminance(back->f) - luminance(f)) < 0.02f * luminance(f);
            off += is_same ? 0 : 1;
        }
        EXPECT_GT(defined, 300);
        EXPECT_GT(of_form, defined / 4);
        // Walks with random decisions may turn at a rounding, of a point or of a direction.
        EXPECT_LE(one_way, defined / 100) << static_cast<int>(kind);
        EXPECT_LE(off, defined / 25) << static_cast<int>(kind);
    }
}

TEST(ReusedPaths, ComeBackByReconnection)
{
    expect_round_trips(wide_frames(), PathForm::ToRay);
}

TEST(ReusedPaths, ComeBackByReplay)
{
    expect_round_trips(narrow_frames(), PathForm::Replay);
}

/// Whether a path reconnects is a property of the path: asked the same from both sides, and paths
/// that do on one side alone have no counterpart.
TEST(ReusedPaths, ThatReconnectOnOneSideAloneAreUndefined)
{
    int close = 0;
    for (uint32_t trial = 0; trial < 5000; ++trial) {
        Rng rng(4, 0, Stream::Test, trial, 0);
        Pair pair = random_pair(wide_frames(), ShiftKind::RandomNumbers, rng);
        std::optional<DrawnPath> path = random_path(pair, trial, rng);
        if (!path || path->y.form == PathForm::Replay) continue;
        // The second vertex is moved next to the first one of the other side.
        const Vec3 x1 = point_at(pair.to_world.frame, pair.to, path->y.u).x;
        path->y.x2 = x1 + 1e-4f * glm::normalize(path->y.x2 - x1) - pair.map.motion;
        pair.map.suffix = SuffixRule::Kept;
        EXPECT_FALSE(shift_path(path->y, pair.from_end(), pair.to_end(), pair.map));
        ++close;
    }
    EXPECT_GT(close, 500);
}

TEST(ReusedPaths, AreUndefinedWithoutSmoke)
{
    Rng rng(5, 0, Stream::Test, 0, 0);
    Pair pair = random_pair(wide_frames(), ShiftKind::World, rng);
    std::optional<DrawnPath> path;
    for (uint32_t trial = 0; !path; ++trial) path = random_path(pair, trial, rng);
    Ray away = pair.to.ray;
    away.d = -away.d;
    BinCounts counts;
    make_path_domain(pair.to_world.frame, away, pair.to, counts);
    ASSERT_TRUE(pair.to.bins.empty());
    for (const ShiftKind kind : kinds) {
        pair.map.kind = kind;
        EXPECT_FALSE(shift_path(path->y, pair.from_end(), pair.to_end(), pair.map));
    }
}

}  // namespace
}  // namespace mote
