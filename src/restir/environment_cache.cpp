#include "restir/environment_cache.h"

#include "core/parallel.h"

namespace mote {
namespace {

/// Side by side in the vector unit; loops over them are meant to be vectorised (this file is
/// compiled with -fno-math-errno, without which a square root is a call).
constexpr int lanes = 8;
using Lanes = float[lanes];

void eval_hg_lanes(const Lanes& cos_theta, float g, float weight, Lanes& sum)
{
    // eval_hg, its constants outside of the loop.
    const float a = std::abs(g);
    const float sign = std::copysign(1.0f, g);
    const float scale = weight * inv_4pi * (1.0f - a) * (1.0f + a);
    for (int n = 0; n < lanes; ++n) {
        const float off_axis = std::max(0.0f, 1.0f - sign * cos_theta[n]);
        const float denom = sqr(1.0f - a) + 2.0f * a * off_axis;
        sum[n] += scale / (denom * std::sqrt(denom));
    }
}

/// Phase function [1/sr] for eight pairs of directions.
void eval_phase_lanes(const Phase& phase, const Lanes& cos_theta, Lanes& value)
{
    std::fill_n(value, lanes, 0.0f);
    eval_hg_lanes(cos_theta, phase.g, 1.0f - phase.weight_b, value);
    if (phase.weight_b > 0.0f) eval_hg_lanes(cos_theta, phase.g_b, phase.weight_b, value);
}

float sum_of(const Lanes& v)
{
    return ((v[0] + v[4]) + (v[1] + v[5])) + ((v[2] + v[6]) + (v[3] + v[7]));
}

/// The phase function convolved with a lobe as wide as a hat. Lobes convolve by multiplying their
/// mean cosines; that of a cap with a hat's solid angle is 1 - 1 / K.
Phase widened(Phase phase, const DirectionHats& hats)
{
    const float mean_cosine = 1.0f - 1.0f / static_cast<float>(hats.count());
    phase.g *= mean_cosine;
    phase.g_b *= mean_cosine;
    return phase;
}

bool same(const Phase& a, const Phase& b)
{
    return a.g == b.g && a.g_b == b.g_b && a.weight_b == b.weight_b;
}

/// 1 / length, or 0 for no direction: the camera may sit on a node.
float inverse_length(float squared)
{
    return squared > 1e-30f ? 1.0f / std::sqrt(squared) : 0.0f;
}

}  // namespace

EnvironmentCache::EnvironmentCache(std::shared_ptr<const DirectionTransmittance> transmittance,
                                   std::vector<Spectrum> radiance, const Media& media,
                                   Vec3 camera_position)
    : transmittance_(std::move(transmittance))
{
    const DirectionHats& hats = transmittance_->hats();
    const size_t size = transmittance_->row_size();
    radiance.resize(static_cast<size_t>(hats.count()), Spectrum(0.0f));
    for (int c = 0; c < 3; ++c) {
        light_[c].assign(size, 0.0f);
        direction_[c].assign(size, 0.0f);
        for (int k = 0; k < hats.count(); ++k) {
            light_[c][static_cast<size_t>(k)] = radiance[static_cast<size_t>(k)][c];
            direction_[c][static_cast<size_t>(k)] = hats.centre(k)[c];
        }
    }
    std::vector<Phase> distinct;
    for (const Volume& volume : media.volumes) {
        size_t i = 0;
        while (i < distinct.size() && !same(distinct[i], volume.phase)) ++i;
        phase_of_volume_.push_back(static_cast<int>(i));
        if (i < distinct.size()) continue;
        distinct.push_back(volume.phase);
        const Phase phase = widened(volume.phase, hats);
        const bool is_isotropic = phase.g == 0.0f && (phase.weight_b == 0.0f || phase.g_b == 0.0f);
        lobes_.push_back({phase, is_isotropic, {}});
    }
    bake(camera_position);
}

void EnvironmentCache::bake(Vec3 camera_position)
{
    if (!transmittance_) return;
    const double start = process_cpu_seconds();
    camera_ = camera_position;
    const SmokeLattice& lattice = transmittance_->lattice();
    stats_ = {};
    for (Lobes& lobe : lobes_) {
        lobe.inscatter.resize(lattice.nodes.size());
        parallel_for(lattice.nodes.size(), 128, [&](size_t begin, size_t end) {
            for (size_t slot = begin; slot < end; ++slot) {
                lobe.inscatter[slot] = at_node(lobe.phase, lattice.position(lattice.nodes[slot]),
                                               transmittance_->row(static_cast<int32_t>(slot)));
            }
        });
        stats_.nodes += lattice.active_count();
        stats_.bytes += static_cast<int64_t>(lobe.inscatter.size() * sizeof(Spectrum));
    }
    stats_.cpu_seconds = process_cpu_seconds() - start;
}

Spectrum EnvironmentCache::at_node(const Phase& phase, Vec3 node, const float* transmittance) const
{
    const Vec3 from_camera = node - camera_;
    const Vec3 d = from_camera * inverse_length(glm::dot(from_camera, from_camera));
    Lanes sum[3] = {};
    for (size_t k = 0; k < transmittance_->row_size(); k += lanes) {
        const float* x = direction_[0].data() + k;
        const float* y = direction_[1].data() + k;
        const float* z = direction_[2].data() + k;
        Lanes cos_theta;
        Lanes value;
        for (int n = 0; n < lanes; ++n) cos_theta[n] = d.x * x[n] + d.y * y[n] + d.z * z[n];
        eval_phase_lanes(phase, cos_theta, value);
        for (int n = 0; n < lanes; ++n) value[n] *= transmittance[k + static_cast<size_t>(n)];
        for (int c = 0; c < 3; ++c) {
            const float* light = light_[c].data() + k;
            for (int n = 0; n < lanes; ++n) sum[c][n] += value[n] * light[n];
        }
    }
    return transmittance_->hats().solid_angle() *
           Spectrum(sum_of(sum[0]), sum_of(sum[1]), sum_of(sum[2]));
}

Spectrum EnvironmentCache::inscatter(int phase, Vec3 x) const
{
    if (!transmittance_) return Spectrum(0.0f);
    const Lobes& lobe = lobes_[static_cast<size_t>(phase)];
    const SmokeLattice& lattice = transmittance_->lattice();
    const SmokeLattice::Corners corners = lattice.corners(x);
    Spectrum sum(0.0f);
    for (int n = 0; n < lanes; ++n) {
        const int32_t slot = corners.slot[n];
        if (slot != 0) {
            sum += corners.weight[n] * lobe.inscatter[static_cast<size_t>(slot)];
        } else if (corners.weight[n] > 0.0f) {  // never in smoke, and slow
            const Vec3i node = corners.first + Vec3i(n & 1, n >> 1 & 1, n >> 2);
            sum += corners.weight[n] *
                   at_node(lobe.phase, lattice.position(node), transmittance_->row(0));
        }
    }
    return sum;
}

Spectrum EnvironmentCache::directional(int phase, Vec3 x, Vec3 wi) const
{
    if (!transmittance_) return Spectrum(0.0f);
    const Lobes& lobe = lobes_[static_cast<size_t>(phase)];
    const SmokeLattice& lattice = transmittance_->lattice();
    const SmokeLattice::Corners corners = lattice.corners(x);
    const DirectionHats::Weights hat = transmittance_->hats().at(wi);

    Lanes d[3];  // camera -> node [unit]
    if (!lobe.is_isotropic) {
        // Rounded as in at_node(): narrow lobes would show the difference.
        const Vec3 lo = lattice.position(corners.first) - camera_;
        const Vec3 hi = lattice.position(corners.first + 1) - camera_;
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
    for (int n = 0; n < lanes; ++n) rows[n] = transmittance_->row(corners.slot[n]);
    Spectrum sum(0.0f);
    for (int e = 0; e < 4; ++e) {
        const auto k = static_cast<size_t>(hat.index[e]);
        Lanes value;
        if (lobe.is_isotropic) {
            std::fill_n(value, lanes, inv_4pi);
        } else {
            Lanes cos_theta;
            const Vec3 w(direction_[0][k], direction_[1][k], direction_[2][k]);
            for (int n = 0; n < lanes; ++n) {
                cos_theta[n] = d[0][n] * w.x + d[1][n] * w.y + d[2][n] * w.z;
            }
            eval_phase_lanes(lobe.phase, cos_theta, value);
        }
        for (int n = 0; n < lanes; ++n) value[n] *= corners.weight[n] * rows[n][k];
        sum += hat.weight[e] * sum_of(value) * Spectrum(light_[0][k], light_[1][k], light_[2][k]);
    }
    return sum;
}

}  // namespace mote
