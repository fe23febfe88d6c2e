#pragma once

#include <span>
#include <vector>

#include "core/float8.h"
#include "multiscatter/path_vertex.h"
#include "restir/coarse_extinction.h"

namespace mote {

/// Henyey-Greenstein lobes side by side, each with a share.
struct LobeLanes {
    Float8 a2{};     ///< (1 - |g|)^2
    Float8 two_a{};  ///< 2 |g|
    Float8 sign{};   ///< of g
    Float8 norm{};   ///< share (1 - g^2) / 4 pi

    void set(int lane, float g, float share);
    /// share times the phase function [1/sr], to 2e-5; cos_theta as for eval_hg.
    [[nodiscard, gnu::always_inline]] Float8 eval(Float8 cos_theta) const
    {
        const Float8 off_axis = max(splat(0.0f), 1.0f - sign * cos_theta);
        const Float8 r = approximate_inv_sqrt(a2 + two_a * off_axis);
        return norm * r * r * r;
    }
};

/// Eight vertices of a group side by side.
struct VertexLanes {
    Float8 x{}, y{}, z{};
    Float8 wo_x{}, wo_y{}, wo_z{};
    LobeLanes lobe, lobe_b;
    Float8 share{};    ///< of the group's paths, that leave from here; they sum to 1
    Float8 is_used{};  ///< 0 in lanes without a vertex, else 1
};

/// A group of vertices, laid out for sums over all of them.
struct LaneGroup {
    std::vector<VertexLanes> lanes;
    bool has_second_lobe = false;

    [[nodiscard]] size_t width() const { return lanes.size() * lane_count; }
    [[nodiscard]] float share(size_t i) const
    {
        return lanes[i / lane_count].share[static_cast<int>(i % lane_count)];
    }
};

/// `members` of the vertices; `shares`: of each member. At least one member.
void fill_lanes(std::span<const PathVertex> vertices, std::span<const int> members,
                std::span<const float> shares, LaneGroup& out);

/// Transmittance between two places in media as far as sharing paths assumes it: by a few lookups
/// of mean extinction, and never so small that a sample could get lost. A function of the two
/// places alone, which is what makes weights sum to 1.
[[nodiscard]] float assumed_transmittance(const CoarseExtinction& extinction, Vec3 y, Vec3 x);

/// kernel[i] = lobe * assumed transmittance * cosine / distance^2 between the group's vertex i and
/// a place y: the density with which the vertex's paths are thought to find it, up to a factor that
/// all vertices have in common. `normal` of a surface; null in media. kernel has group.width()
/// elements. Surfaces in between are the caller's business.
void eval_kernels(const LaneGroup& group, const CoarseExtinction& extinction, Vec3 y,
                  const Vec3* normal, std::span<float> kernel);

/// How a group's vertices look at a place.
struct GroupView {
    float density = 0.0f;  ///< sum over the vertices of share times kernel; 0: out of sight
    Vec3 middle{0.0f};     ///< mean direction from the place to the vertices, by share times kernel
};
[[nodiscard]] GroupView view_of(const LaneGroup& group, Vec3 y, std::span<const float> kernel);

/// Gives a vertex in a medium one lobe for all ways on from it: around their middle, and the wider
/// the more they differ. Any lobe will do that is nowhere 0.
void aim_lobe(const GroupView& view, PathVertex& v);

/// Sums per vertex of a group and per channel.
struct LaneSums {
    std::vector<Float8> r, g, b;

    void clear(size_t lanes);
    [[nodiscard]] Spectrum at(size_t i) const
    {
        const auto lane = static_cast<int>(i % lane_count);
        const size_t l = i / lane_count;
        return {r[l][lane], g[l][lane], b[l][lane]};
    }
    void add(size_t i, Spectrum s)
    {
        const auto lane = static_cast<int>(i % lane_count);
        r[i / lane_count][lane] += s.x;
        g[i / lane_count][lane] += s.y;
        b[i / lane_count][lane] += s.z;
    }
};

/// Adds to each vertex of the group kernel[i] times the light that vertex y, in a medium, scatters
/// there. brought[i]: the magnitude of its largest channel.
void scatter_to_group(const LaneGroup& group, const PathVertex& y, std::span<const float> kernel,
                      LaneSums& sums, std::span<float> brought);

}  // namespace mote
