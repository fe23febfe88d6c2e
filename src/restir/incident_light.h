#pragma once

#include <optional>

#include "restir/frame_domain.h"
#include "restir/path_sample.h"

namespace mote {

/// Light of one sample at a scattering point, as if nothing were in the way.
struct Arrival {
    Vec3 wi{0.0f};          ///< towards the light [unit]
    float distance = 0.0f;  ///< infinity for lights at infinity [m]
    Spectrum L{0.0f};  ///< radiance times what turns the sample's measure into solid angle: the sum
                       ///< of L times phase function over samples is in-scattered radiance
};

/// The light that a sample stands for at point x. Empty if it does not shine there.
[[nodiscard]] std::optional<Arrival> light_at(const FrameDomain& frame, const PathSample& y, Vec3 x,
                                              float time);

/// Albedo times phase function [1/sr] of all media at x, each with its share of the extinction.
[[nodiscard]] Spectrum scattering_at(const FrameDomain& frame, Vec3 x, float time, Vec3 wo,
                                     Vec3 wi);

/// Expected in-scattered radiance (luminance) of the lights that take part in the candidates. From
/// the caches: any value >= 0.
[[nodiscard]] float sampled_inscatter(const FrameDomain& frame, Vec3 x, Vec3 wo);

/// A light chosen for a candidate.
struct SampledChoice {
    int light = -1;    ///< into FrameDomain::lights; -1: none
    float pmf = 0.0f;  ///< > 0
};

/// Chooses one of the frame's lights at x about in proportion to what it brings. u in [0,1),
/// stretched rather than replaced, so that stratified u give stratified lights.
[[nodiscard]] SampledChoice choose_light(const FrameDomain& frame, Vec3 x, Vec3 wo, float u);

/// Probability of choose_light returning this light; > 0 for every light that shines.
[[nodiscard]] float light_pmf(const FrameDomain& frame, int light, Vec3 x, Vec3 wo);

}  // namespace mote
