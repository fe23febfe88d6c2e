#pragma once

#include "volumes/media_at.h"

namespace mote {

/// Media at a point, each with its share of the extinction. Of more than `capacity` media the first
/// count, so that the shares may sum to less than 1: for control variates, which any mixture
/// serves.
struct MediaMixture {
    static constexpr int capacity = 4;
    struct Part {
        const Volume* volume = nullptr;
        float share = 0.0f;
        Spectrum albedo{0.0f};
    };
    Part parts[capacity];
    int count = 0;
};

/// The mixture at a world point; empty where nothing scatters.
[[nodiscard]] inline MediaMixture mixture_at(const Media& media, Vec3 x, float time)
{
    MediaMixture out;
    for_each_scatterer(media, x, time, [&](const Volume& volume, float share, Spectrum albedo) {
        if (out.count == MediaMixture::capacity) return;
        out.parts[out.count++] = {&volume, share, albedo};
    });
    return out;
}

}  // namespace mote
