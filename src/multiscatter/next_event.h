#pragma once

#include <optional>

#include "reference/trace_segment.h"

namespace mote {

/// Where a ray's segment ended, about to scatter.
struct NextEvent {
    ScatterEvent event;
    Spectrum albedo{1.0f};  ///< of the medium; what surfaces absorb is in their scattering
};

/// The event at the end of a ray; empty where nothing scatters. A surface's vertex stays in the
/// segment, which must outlive the event.
[[nodiscard]] std::optional<NextEvent> next_event(const Scene& scene, const Ray& ray,
                                                  const TracedSegment& segment);

/// All light that an event scatters, once and more, a medium's albedo left out: unbiased, by a
/// shadow ray and a path. `event_count`: of the path, this event included. What max_bounces cuts
/// (PathResult::cut) is added to `cut`.
[[nodiscard]] Spectrum light_of_event(const TraceContext& context, const ScatterEvent& event,
                                      int event_count, Rng& rng, float& cut);

}  // namespace mote
