#pragma once

#include "render/camera_pass.h"
#include "restir/light_rays.h"

namespace mote {

/// Whether the lamps that a pixel sees have rays of their own in its passes.
[[nodiscard]] bool has_lamp_rays(const PassInputs& inputs, const PassKey& key);

/// Stratified camera rays through the pixel, where has_lamp_rays(): of those that meet a lamp, any
/// one, as likely as the others, is asked for its transmittance, for all of them. `weight`: of what
/// they bring to `owner`. Cost: 0.05 to 0.1 us per stratum, and a ray through the media per lamp.
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
