#pragma once

#include <optional>

#include "core/rng.h"
#include "reference/trace_context.h"

namespace mote {

/// A lamp that light grows towards: where it is, and the size below which distance does not matter.
struct SmallLamp {
    Vec3 position{0.0f};
    float radius = 0.0f;  ///< [m]
};

/// Point, spot and sphere lights are small lamps; empty for all others.
[[nodiscard]] std::optional<SmallLamp> small_lamp(const Light& light);

/// The part of a camera ray where its first event may be.
struct CameraSegment {
    Ray ray;
    Interval range;
    Vec3 middle{0.0f};  ///< where a lamp is chosen
};

/// A first event found by free flight, as a competitor of equiangular sampling.
struct FirstEvent {
    const CameraSegment* segment = nullptr;
    float t = 0.0f;
    float flight_pdf = 0.0f;  ///< sigma_t T [1/m]; T exact, so that both sides agree on weights
};

/// Empty if the ray misses all media before t_max.
[[nodiscard]] std::optional<CameraSegment> make_camera_segment(const Media& media, const Ray& ray,
                                                               float t_max);

/// The first event at distance t on a segment.
[[nodiscard]] FirstEvent make_first_event(const Media& media, const CameraSegment& segment,
                                          float t);

/// Density of choosing this lamp and the event's distance by equiangular sampling, over the free
/// flight's density of that distance. 0 for lamps that are neither points nor spheres, or too far
/// away for distances to matter.
[[nodiscard]] float equiangular_ratio(const TraceContext& context, const FirstEvent& event,
                                      int lamp);

/// Single scattering off a point or sphere lamp, at a distance drawn in proportion to the inverse
/// square of the distance to the lamp, weighted by MIS against free flights. Takes the 1/d^2 spikes
/// out of lamps in and near media. Covers the camera ray's first event only: later events rely on
/// free flights. Source: Kulla and Fajardo 2012.
[[nodiscard]] Spectrum estimate_equiangular(const TraceContext& context,
                                            const CameraSegment& segment, Rng& rng);

}  // namespace mote
