#include "restir/wide_inscatter.h"

#include "core/parallel.h"

namespace mote {
namespace {

/// Side by side in the vector unit; loops over them are meant to be vectorised (this file is
/// compiled with -fno-math-errno, without which a square root is a call).
constexpr int lanes = 8;
using Lanes = float[lanes];

void add_hg(const Lanes& cos_theta, float g, float weight, Lanes& sum)
{
    // eval_hg, its constants outside of the loop.
    const float a = std::abs(g);
    const float sign = std::copysign(1.0f, g);
    const float least = sqr(1.0f - a);
    const float scale = weight * inv_4pi * (1.0f - a) * (1.0f + a);
    for (int n = 0; n < lanes; ++n) {
        const float off_axis = std::max(0.0f, 1.0f - sign * cos_theta[n]);
        const float denom = least + 2.0f * a * off_axis;
        sum[n] += scale / (denom * std::sqrt(denom));
    }
}

/// Phase function [1/sr] for eight pairs of directions.
void eval_phase_lanes(const Phase& phase, const Lanes& cos_theta, Lanes& value)
{
    std::fill_n(value, lanes, 0.0f);
    add_hg(cos_theta, phase.g, 1.0f - phase.weight_b, value);
    if (phase.weight_b > 0.0f) add_hg(cos_theta, phase.g_b, phase.weight_b, value);
}

float sum_of(const Lanes& v)
{
    return ((v[0] + v[4]) + (v[1] + v[5])) + ((v[2] + v[6]) + (v[3] + v[7]));
}

/// 1 / length, or 0 for no direction: the camera may sit on a node.
float inverse_length(float squared)
{
    return squared > 1e-30f ? 1.0f / std::sqrt(squared) : 0.0f;
}

}  // namespace

WideInscatter::WideInscatter(const Phase& phase, const EnvironmentNodes& nodes)
    : phase_(phase), is_isotropic_(phase.g == 0.0f && (phase.weight_b == 0.0f || phase.g_b == 0.0f))
{
    const DirectionTransmittance& transmittance = *nodes.transmittance;
    for (int c = 0; c < 3; ++c) {
        light_[c].assign(transmittance.row_size(), 0.0f);
        direction_[c].assign(transmittance.row_size(), 0.0f);
        for (int k = 0; k < transmittance.hats().count(); ++k) {
            light_[c][static_cast<size_t>(k)] = nodes.radiance[static_cast<size_t>(k)][c];
            direction_[c][static_cast<size_t>(k)] = transmittance.hats().centre(k)[c];
        }
    }
    const SmokeLattice& lattice = nodes.lattice();
    inscatter_.resize(lattice.nodes.size());
    parallel_for(inscatter_.size(), 128, [&](size_t begin, size_t end) {
        for (size_t slot = begin; slot < end; ++slot) {
            inscatter_[slot] = at_node(nodes, lattice.position(lattice.nodes[slot]),
                                       transmittance.row(static_cast<int32_t>(slot)));
        }
    });
}

int64_t WideInscatter::memory_bytes() const
{
    return static_cast<int64_t>(inscatter_.size() * sizeof(Spectrum));
}

Spectrum WideInscatter::at_node(const EnvironmentNodes& nodes, Vec3 position,
                                const float* transmittance) const
{
    const Vec3 from_camera = position - nodes.camera;
    const Vec3 d = from_camera * inverse_length(glm::dot(from_camera, from_camera));
    Lanes sum[3] = {};
    for (size_t k = 0; k < nodes.transmittance->row_size(); k += lanes) {
        const float* x = direction_[0].data() + k;
        const float* y = direction_[1].data() + k;
        const float* z = direction_[2].data() + k;
        Lanes cos_theta;
        Lanes value;
        for (int n = 0; n < lanes; ++n) cos_theta[n] = d.x * x[n] + d.y * y[n] + d.z * z[n];
        eval_phase_lanes(phase_, cos_theta, value);
        for (int n = 0; n < lanes; ++n) value[n] *= transmittance[k + static_cast<size_t>(n)];
        for (int c = 0; c < 3; ++c) {
            const float* light = light_[c].data() + k;
            for (int n = 0; n < lanes; ++n) sum[c][n] += value[n] * light[n];
        }
    }
    return nodes.transmittance->hats().solid_angle() *
           Spectrum(sum_of(sum[0]), sum_of(sum[1]), sum_of(sum[2]));
}

Spectrum WideInscatter::inscatter(const EnvironmentNodes& nodes, Vec3 x) const
{
    return interpolate_nodes(nodes.lattice(), inscatter_, x, [&](Vec3 position) {
        return at_node(nodes, position, nodes.transmittance->row(0));
    });
}

Spectrum WideInscatter::directional(const EnvironmentNodes& nodes, Vec3 x, Vec3 /*wo*/,
                                    Vec3 wi) const
{
    const SmokeLattice& lattice = nodes.lattice();
    const SmokeLattice::Corners corners = lattice.corners(x);
    const DirectionHats::Weights hat = nodes.transmittance->hats().at(wi);
    Lanes d[3];  // camera -> node [unit]
    if (!is_isotropic_) {
        // Rounded as in at_node(): narrow lobes would show the difference.
        const Vec3 lo = lattice.position(corners.first) - nodes.camera;
        const Vec3 hi = lattice.position(corners.first + 1) - nodes.camera;
        for (int n = 0; n < lanes; ++n) {
            const float dx = (n & 1) != 0 ? hi.x : lo.x;
            const float dy = (n & 2) != 0 ? hi.y : lo.y;
            const float dz = (n & 4) != 0 ? hi.z : lo.z;
            const float inv = inverse_length(dx * dx + dy * dy + dz * dz);
            d[0][n] = dx * inv;
            d[1][n] = dy * inv;
            d[2][n] = dz * inv;
        }
    }
    const float* rows[lanes];
    for (int n = 0; n < lanes; ++n) rows[n] = nodes.transmittance->row(corners.slot[n]);
    Spectrum sum(0.0f);
    for (int e = 0; e < 4; ++e) {
        const auto k = static_cast<size_t>(hat.index[e]);
        Lanes value;
        if (is_isotropic_) {
            std::fill_n(value, lanes, inv_4pi);
        } else {
            Lanes cos_theta;
            const Vec3 w(direction_[0][k], direction_[1][k], direction_[2][k]);
            for (int n = 0; n < lanes; ++n) {
                cos_theta[n] = d[0][n] * w.x + d[1][n] * w.y + d[2][n] * w.z;
            }
            eval_phase_lanes(phase_, cos_theta, value);
        }
        for (int n = 0; n < lanes; ++n) value[n] *= corners.weight[n] * rows[n][k];
        sum += hat.weight[e] * sum_of(value) * Spectrum(light_[0][k], light_[1][k], light_[2][k]);
    }
    return sum;
}

}  // namespace mote
