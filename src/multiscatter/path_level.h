#pragma once

#include <span>
#include <vector>

#include "multiscatter/mean_radiance.h"
#include "multiscatter/vertex_groups.h"
#include "reference/trace_context.h"
#include "restir/coarse_extinction.h"
#include "volumes/depth_batch.h"

namespace mote {

/// Vertices with one number of events between them and the camera, and how the paths that leave
/// them are shared.
struct PathLevel {
    std::vector<PathVertex> vertices;
    std::vector<SurfaceVertex> surfaces;
    std::vector<int> order;           ///< of the vertices in media, by group
    std::vector<VertexGroup> groups;  ///< into order
    std::vector<VertexGroup> found;   ///< per group: what its paths found, into the next level
    std::vector<size_t> kernel_of;    ///< per group: its first kernel
    /// Per group and vertex found, for all lanes of the group: what part of that vertex's light
    /// towards the lane's vertex this one takes. See send_paths.
    std::vector<float> kernels;

    [[nodiscard]] std::span<const int> members(const VertexGroup& group) const
    {
        return std::span(order).subspan(group.first, group.count);
    }
    [[nodiscard]] ScatterEvent event(const PathVertex& v, float time) const
    {
        if (v.surface < 0) return {v.x, v.wo, time, &v.lobe};
        ScatterEvent event{v.x, v.wo, time};
        event.surface = &surfaces[static_cast<size_t>(v.surface)];
        return event;
    }
};

/// What all steps of sharing read, and what they count.
struct SharingContext {
    const TraceContext& trace;
    const CoarseExtinction& extinction;  ///< for assumed transmittances
    size_t group_size = 64;              ///< vertices that share their paths
    float time = 0.0f;                   ///< of all rays
    WalkCounts& counts;
    float& cut;  ///< weight, in the image, that paths had left when max_bounces cut them
    float near_share = 0.0f;              ///< see PathSharing
    const MeanRadiance* known = nullptr;  ///< see PathSharing
};

}  // namespace mote
