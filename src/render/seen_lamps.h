#pragma once

#include "render/camera_pass.h"
#include "restir/light_rays.h"

namespace mote {

/// Whether a lamp, in the pixel, has rays of its own in the pixel's passes.
[[nodiscard]] bool has_lamp_rays(const PassInputs& inputs, const PassKey& key, int light);

/// Stratified camera rays to the lamps that have rays of their own: of those that meet a lamp, any
/// one, as likely as the others, is asked for its transmittance, for all of them. Lamps in the
/// pixel's list are looked for where they are on the film (their boxes), so that a lamp down to a
/// hundredth of the pixel's width is found by most rays; others all over the pixel. `weight`: of
/// what they bring to `owner`. Cost: 0.03 to 0.1 us per stratum, and a ray through the media per
/// lamp.
void look_for_lamps(const PassInputs& inputs, const PassKey& key, int owner, float weight,
                    LightRays& rays);

/// Traces those rays; what each brings is added to sample_of(owner).
template <class SampleOf>
void add_seen_lamps(const Scene& scene, LightRays& rays, WalkCounts& counts, SampleOf&& sample_of)
{
    rays.trace(scene, counts);
    for (size_t i = 0; i < rays.size(); ++i) {
        FilmSample& sample = sample_of(rays.owners[i]);
        sample.background += rays.value(i);
        sample.exact_rays += 1.0f;
    }
}

}  // namespace mote
