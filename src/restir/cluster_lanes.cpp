#include "restir/cluster_lanes.h"

namespace mote {
namespace {

/// (1 + v tau)^(-1/v); v >= 1e-3 (there it is about exp(-tau)).
[[gnu::always_inline]] inline Float8 doubtful_transmittance(const Float8& tau, const Float8& v)
{
    return approximate_exp(-approximate_log(1.0f + v * tau) / v);
}

/// Henyey-Greenstein as eval_hg has it, without its care for narrow peaks.
[[gnu::always_inline]] inline Float8 hg(const Float8& cos_theta, const Float8& g)
{
    const Float8 r = approximate_inv_sqrt(max(1.0f + g * g - 2.0f * g * cos_theta, splat(1e-6f)));
    return inv_4pi * (1.0f - g * g) * r * r * r;
}

}  // namespace

void ClusterLanes::set(int lane, const LightCluster& cluster)
{
    x[lane] = cluster.centre.x;
    y[lane] = cluster.centre.y;
    z[lane] = cluster.centre.z;
    power[lane] = cluster.power;
    spread2[lane] = cluster.spread2;
    facing_x[lane] = cluster.facing.x;
    facing_y[lane] = cluster.facing.y;
    facing_z[lane] = cluster.facing.z;
}

void eval_fluence(const ClusterLanes& c, const CoarseExtinction& extinction, Vec3 x, float blur2,
                  int steps, FluenceLanes& out)
{
    coarse_optical_depths(extinction, x, c.x, c.y, c.z, steps, out.tau);
    const Float8 dx = x.x - c.x;
    const Float8 dy = x.y - c.y;
    const Float8 dz = x.z - c.z;
    const Float8 distance2 = dx * dx + dy * dy + dz * dz + 1e-30f;
    const Float8 inv = approximate_inv_sqrt(max(distance2, max(0.5f * c.spread2, splat(blur2))));
    // A cosine lobe to its first order, 1 + 2 cos: right on average, never quite dark.
    const Float8 cos_theta = (dx * c.facing_x + dy * c.facing_y + dz * c.facing_z) * inv;
    const Float8 clear = c.power * inv_4pi * inv * inv * max(splat(0.05f), 1.0f + 2.0f * cos_theta);
    const Float8 v = min(splat(1.0f), c.spread2 / distance2) + 1e-3f;
    out.expected = clear * doubtful_transmittance(out.tau, v);
    out.weight = clear * doubtful_transmittance(out.tau, v + coarse_doubt);
}

void eval_phase(const ClusterLanes& c, Vec3 x, Vec3 wo, const Phase& phase, float blur2,
                Float8& out)
{
    const Float8 dx = c.x - x.x;
    const Float8 dy = c.y - x.y;
    const Float8 dz = c.z - x.z;
    const Float8 distance2 = dx * dx + dy * dy + dz * dz + 1e-30f;
    const Float8 inv = approximate_inv_sqrt(distance2);
    // A lobe averaged over directions of mean cosine a is about the lobe of a times g.
    const Float8 a = distance2 * inv * approximate_inv_sqrt(distance2 + c.spread2 + blur2);
    const Float8 cos_theta = -(wo.x * dx + wo.y * dy + wo.z * dz) * inv;
    out = hg(cos_theta, a * phase.g);
    if (phase.weight_b > 0.0f) out += phase.weight_b * (hg(cos_theta, a * phase.g_b) - out);
}

}  // namespace mote
