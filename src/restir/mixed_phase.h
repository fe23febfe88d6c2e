#pragma once

#include <algorithm>

#include "volumes/media_at.h"

namespace mote {

/// Phase functions of the media at a point, each with its share of the extinction: a density of
/// directions. Of more than `capacity` media at one point the first count, the shares stretched:
/// any mixture is a valid density as long as sampling and pdf agree.
struct MixedPhase {
    static constexpr int capacity = 4;
    const Phase* phases[capacity]{};
    float shares[capacity]{};
    int count = 0;

    [[nodiscard]] bool empty() const { return count == 0; }

    /// [1/sr]
    [[nodiscard]] float pdf(Vec3 wo, Vec3 wi) const
    {
        float sum = 0.0f;
        for (int i = 0; i < count; ++i) sum += shares[i] * phase_pdf(*phases[i], wo, wi);
        return sum;
    }

    /// Direction in proportion to pdf; precondition: not empty. u_choice in [0,1), u in [0,1)^2.
    [[nodiscard]] Vec3 sample(Vec3 wo, float u_choice, Vec2 u) const
    {
        int i = 0;
        for (float before = shares[0]; i + 1 < count && u_choice >= before;) before += shares[++i];
        return sample_phase(*phases[i], wo, u);
    }
};

/// The mixture at a world point; empty where nothing scatters.
[[nodiscard]] inline MixedPhase mixed_phase_at(const Media& media, Vec3 x, float time)
{
    MixedPhase out;
    float sum = 0.0f;
    for_each_scatterer(media, x, time, [&](const Volume& volume, float share, Spectrum) {
        if (out.count == MixedPhase::capacity) return;
        out.phases[out.count] = &volume.phase;
        out.shares[out.count++] = share;
        sum += share;
    });
    for (int i = 0; i < out.count; ++i) out.shares[i] /= sum;
    return out;
}

}  // namespace mote
