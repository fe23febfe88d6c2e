#include "multiscatter/vertex_lanes.h"

#include <algorithm>
#include <cmath>

namespace mote {
namespace {

/// Vertices closer together count as this far apart [m^2].
constexpr float least_distance2 = 1e-30f;

/// Lookups for an assumed transmittance.
constexpr int lookups = 4;

/// The ways from a group's vertices to a place.
struct Ways {
    Float8 x, y, z;     ///< [unit]
    Float8 inv_length;  ///< [1/m]
};

[[gnu::always_inline]] inline Ways ways_to(const VertexLanes& v, Vec3 y)
{
    Ways w;
    w.x = y.x - v.x;
    w.y = y.y - v.y;
    w.z = y.z - v.z;
    const Float8 length2 = max(w.x * w.x + w.y * w.y + w.z * w.z, splat(least_distance2));
    w.inv_length = approximate_inv_sqrt(length2);
    w.x *= w.inv_length;
    w.y *= w.inv_length;
    w.z *= w.inv_length;
    return w;
}

/// exp(-tau), but with a tail that falls slowly.
[[gnu::always_inline]] inline Float8 with_tail(Float8 tau)
{
    const Float8 t = 1.0f / (1.0f + tau);
    return approximate_exp(-tau) + 0.01f * t * t;
}

[[gnu::always_inline]] inline float sum_of(Float8 v)
{
    float sum = 0.0f;
    for (int i = 0; i < lane_count; ++i) sum += v[i];
    return sum;
}

}  // namespace

void LobeLanes::set(int lane, float g, float share)
{
    const float a = std::abs(g);
    a2[lane] = (1.0f - a) * (1.0f - a);
    two_a[lane] = 2.0f * a;
    sign[lane] = std::copysign(1.0f, g);
    norm[lane] = share * inv_4pi * (1.0f - a) * (1.0f + a);
}

void LaneSums::clear(size_t lanes)
{
    r.assign(lanes, Float8{});
    g = b = r;
}

void fill_lanes(std::span<const PathVertex> vertices, std::span<const int> members,
                std::span<const float> shares, LaneGroup& out)
{
    out.lanes.assign((members.size() + lane_count - 1) / lane_count, VertexLanes{});
    out.has_second_lobe = false;
    for (size_t i = 0; i < out.width(); ++i) {
        VertexLanes& v = out.lanes[i / lane_count];
        const auto k = static_cast<int>(i % lane_count);
        const bool is_used = i < members.size();
        const PathVertex& p = vertices[static_cast<size_t>(is_used ? members[i] : members[0])];
        v.x[k] = p.x.x;
        v.y[k] = p.x.y;
        v.z[k] = p.x.z;
        v.wo_x[k] = p.wo.x;
        v.wo_y[k] = p.wo.y;
        v.wo_z[k] = p.wo.z;
        v.lobe.set(k, p.lobe.g, 1.0f - p.lobe.weight_b);
        v.lobe_b.set(k, p.lobe.g_b, p.lobe.weight_b);
        out.has_second_lobe |= p.lobe.weight_b > 0.0f;
        v.is_used[k] = is_used ? 1.0f : 0.0f;
        v.share[k] = is_used ? shares[i] : 0.0f;
    }
}

float assumed_transmittance(const CoarseExtinction& extinction, Vec3 y, Vec3 x)
{
    Float8 tau;
    coarse_optical_depths(extinction, y, splat(x.x), splat(x.y), splat(x.z), lookups, tau);
    return with_tail(tau)[0];
}

void eval_kernels(const LaneGroup& group, const CoarseExtinction& extinction, Vec3 y,
                  const Vec3* normal, std::span<float> kernel)
{
    for (size_t i = 0; i < group.lanes.size(); ++i) {
        const VertexLanes& v = group.lanes[i];
        const Ways w = ways_to(v, y);
        const Float8 cos_theta = -(v.wo_x * w.x + v.wo_y * w.y + v.wo_z * w.z);
        Float8 k = v.lobe.eval(cos_theta);
        if (group.has_second_lobe) k += v.lobe_b.eval(cos_theta);
        Float8 tau;
        coarse_optical_depths(extinction, y, v.x, v.y, v.z, lookups, tau);
        k *= v.is_used * with_tail(tau) * (w.inv_length * w.inv_length);
        if (normal) k *= abs(normal->x * w.x + normal->y * w.y + normal->z * w.z);
        store(kernel.data() + i * lane_count, k);
    }
}

GroupView view_of(const LaneGroup& group, Vec3 y, std::span<const float> kernel)
{
    Float8 density{};
    Float8 x_sum{};
    Float8 y_sum{};
    Float8 z_sum{};
    for (size_t i = 0; i < group.lanes.size(); ++i) {
        const Ways w = ways_to(group.lanes[i], y);
        const Float8 part = group.lanes[i].share * load(kernel.data() + i * lane_count);
        density += part;
        x_sum -= part * w.x;
        y_sum -= part * w.y;
        z_sum -= part * w.z;
    }
    const float sum = sum_of(density);
    if (!(sum > 0.0f)) return {};
    return {sum, Vec3(sum_of(x_sum), sum_of(y_sum), sum_of(z_sum)) / sum};
}

void aim_lobe(const GroupView& view, PathVertex& v)
{
    // Directions are rounded, and those between vertices in one place have no length.
    const float length = std::min(glm::length(view.middle), 1.0f);
    v.wo = length > 0.0f ? view.middle / length : Vec3(0.0f, 0.0f, 1.0f);
    v.lobe = *v.phase;
    v.lobe.g *= length;
    v.lobe.g_b *= length;
}

void scatter_to_group(const LaneGroup& group, const PathVertex& y, std::span<const float> kernel,
                      LaneSums& sums, std::span<float> brought)
{
    LobeLanes lobe;
    LobeLanes lobe_b;
    for (int k = 0; k < lane_count; ++k) {
        lobe.set(k, y.phase->g, 1.0f - y.phase->weight_b);
        lobe_b.set(k, y.phase->g_b, y.phase->weight_b);
    }
    for (size_t i = 0; i < group.lanes.size(); ++i) {
        const Ways w = ways_to(group.lanes[i], y.x);
        Float8 r{};
        Float8 g{};
        Float8 b{};
        for (int a = 0; a < y.arrival_count; ++a) {
            const IncidentSample& arrival = y.arrivals[a];
            // Light goes on along -w, so that cos_theta = -dot(wo, wi) = dot(w, wi).
            const Float8 cos_theta = w.x * arrival.wi.x + w.y * arrival.wi.y + w.z * arrival.wi.z;
            Float8 f = lobe.eval(cos_theta);
            if (y.phase->weight_b > 0.0f) f += lobe_b.eval(cos_theta);
            r += f * arrival.E.x;
            g += f * arrival.E.y;
            b += f * arrival.E.z;
        }
        const Float8 k = load(kernel.data() + i * lane_count);
        r *= k * y.weight.x;
        g *= k * y.weight.y;
        b *= k * y.weight.z;
        sums.r[i] += r;
        sums.g[i] += g;
        sums.b[i] += b;
        store(brought.data() + i * lane_count, max(abs(r), max(abs(g), abs(b))));
    }
}

}  // namespace mote
