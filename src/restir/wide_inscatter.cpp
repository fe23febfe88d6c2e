#include "restir/wide_inscatter.h"

#include "core/parallel.h"

namespace mote {
namespace {

/// Side by side in the vector unit; loops over them are meant to be vectorised (this file is
/// compiled with -fno-math-errno, without which a square root is a call).
constexpr size_t lanes = 8;

/// value += weight * eval_hg(cos_theta, g), its constants outside of the loop.
inline void add_hg(const float* __restrict cos_theta, float g, float weight,
                   float* __restrict value)
{
    const float a = std::abs(g);
    const float sign = std::copysign(1.0f, g);
    const float least = sqr(1.0f - a);
    const float scale = weight * inv_4pi * (1.0f - a) * (1.0f + a);
    for (size_t n = 0; n < lanes; ++n) {
        // Above 0 for rounded cosines too: lobes are wide.
        const float denom = least + 2.0f * a * (1.0f - sign * cos_theta[n]);
        value[n] += scale / (denom * std::sqrt(denom));
    }
}

float sum_of(const float* v)
{
    return ((v[0] + v[4]) + (v[1] + v[5])) + ((v[2] + v[6]) + (v[3] + v[7]));
}

/// Direction from the camera; 0 for none: the camera may sit on a node.
Vec3 view_direction(const EnvironmentNodes& nodes, Vec3 position)
{
    const Vec3 d = position - nodes.camera;
    const float squared = glm::dot(d, d);
    return squared > 1e-30f ? d / std::sqrt(squared) : Vec3(0.0f);
}

}  // namespace

WideInscatter::WideInscatter(const Phase& phase, const EnvironmentNodes& nodes) : phase_(phase)
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
    const size_t size = transmittance.row_size();
    inscatter_.resize(lattice.nodes.size());
    scattered_.resize(inscatter_.size() * size);
    parallel_for(inscatter_.size(), 128, [&](size_t begin, size_t end) {
        for (size_t slot = std::max<size_t>(begin, 1); slot < end; ++slot) {
            const Vec3 d = view_direction(nodes, lattice.position(lattice.nodes[slot]));
            float* row = scattered_.data() + slot * size;
            scatter(d, transmittance.row(static_cast<int32_t>(slot)), row);
            inscatter_[slot] =
                PaddedSpectrum(transmittance.hats().solid_angle() * sum_of_light(row));
        }
    });
}

int64_t WideInscatter::memory_bytes() const
{
    return static_cast<int64_t>(inscatter_.size() * sizeof(PaddedSpectrum) +
                                scattered_.size() * sizeof(float));
}

void WideInscatter::scatter(Vec3 d, const float* transmittance, float* row) const
{
    for (size_t k = 0; k < light_[0].size(); k += lanes) {
        const float* x = direction_[0].data() + k;
        const float* y = direction_[1].data() + k;
        const float* z = direction_[2].data() + k;
        float cos_theta[lanes];
        float value[lanes] = {};
        for (size_t n = 0; n < lanes; ++n) cos_theta[n] = d.x * x[n] + d.y * y[n] + d.z * z[n];
        add_hg(cos_theta, phase_.g, 1.0f - phase_.weight_b, value);
        if (phase_.weight_b > 0.0f) add_hg(cos_theta, phase_.g_b, phase_.weight_b, value);
        for (size_t n = 0; n < lanes; ++n) row[k + n] = value[n] * transmittance[k + n];
    }
}

Spectrum WideInscatter::sum_of_light(const float* row) const
{
    Spectrum out;
    for (int c = 0; c < 3; ++c) {
        float sum[lanes] = {};
        for (size_t k = 0; k < light_[c].size(); k += lanes) {
            for (size_t n = 0; n < lanes; ++n) sum[n] += row[k + n] * light_[c][k + n];
        }
        out[c] = sum_of(sum);
    }
    return out;
}

Spectrum WideInscatter::inscatter(const EnvironmentNodes& nodes, Vec3 x) const
{
    return interpolate_nodes(nodes.lattice(), inscatter_, x, [&](Vec3 position) {
        std::vector<float> row(light_[0].size());
        scatter(view_direction(nodes, position), nodes.transmittance->row(0), row.data());
        return nodes.transmittance->hats().solid_angle() * sum_of_light(row.data());
    });
}

Spectrum WideInscatter::directional(const EnvironmentNodes& nodes, Vec3 x,
                                    const DirectionHats::Weights& hat) const
{
    const SmokeLattice& lattice = nodes.lattice();
    const SmokeLattice::Corners corners = lattice.corners(x);
    const size_t size = light_[0].size();
    float sum[4] = {};
    for (int n = 0; n < 8; ++n) {
        const float weight = corners.weight[n];
        if (corners.slot[n] != 0) {
            const float* row = scattered_.data() + static_cast<size_t>(corners.slot[n]) * size;
            for (int e = 0; e < 4; ++e) sum[e] += weight * row[hat.index[e]];
        } else if (weight > 0.0f) {  // never in smoke, and slow
            std::vector<float> row(size);
            scatter(view_direction(nodes, lattice.position(corners.node(n))),
                    nodes.transmittance->row(0), row.data());
            for (int e = 0; e < 4; ++e) sum[e] += weight * row[static_cast<size_t>(hat.index[e])];
        }
    }
    Spectrum out(0.0f);
    for (int e = 0; e < 4; ++e) {
        const auto k = static_cast<size_t>(hat.index[e]);
        out += hat.weight[e] * sum[e] * Spectrum(light_[0][k], light_[1][k], light_[2][k]);
    }
    return out;
}

}  // namespace mote
