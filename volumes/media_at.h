#pragma once

#include "volumes/tracking.h"

namespace mote {

/// Calls f(volume, p_local, sigma_t) for each medium with extinction at a world point; p_local is
/// in the local coordinates of its density grid. One lookup per volume.
template <class F>
void for_each_medium_at(const Media& media, Vec3 p, float time, F&& f)
{
    for (const Volume& volume : media.volumes) {
        if (is_void(volume)) continue;
        const Vec3 local(volume.at_rest ? volume.at_rest->density.point(p)
                                        : frames_at(volume, time).density.point(p));
        const float sigma_t = volume.density_scale * sample_local(*volume.density, local);
        if (sigma_t > 0.0f) f(volume, local, sigma_t);
    }
}

/// Calls f(volume, share, albedo) for each medium that may scatter at a world point of a ray; the
/// shares of extinction sum to 1. With one medium of one colour this needs no lookup.
template <class F>
void for_each_scatterer(const Media& media, Vec3 p, float time, F&& f)
{
    if (media.volumes.size() == 1 && !media.volumes.front().color) {
        f(media.volumes.front(), 1.0f, media.volumes.front().albedo);
        return;
    }
    float sum = 0.0f;
    const bool alone = media.volumes.size() == 1;
    if (!alone) {
        for_each_medium_at(media, p, time, [&](const Volume&, Vec3, float s) { sum += s; });
        if (!(sum > 0.0f)) return;
    }
    for_each_medium_at(media, p, time, [&](const Volume& volume, Vec3 local, float sigma_t) {
        f(volume, alone ? 1.0f : sigma_t / sum,
          albedo_at(volume, object_from_local(volume).point(local)));
    });
}

}  // namespace mote
