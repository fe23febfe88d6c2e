#pragma once

#include <span>

#include "volumes/tracking.h"

namespace mote {

struct DepthQuery {
    Vec3 o{0.0f};
    float t1 = 0.0f;
    Vec3 d{0.0f};
    float time = 0.0f;
    float tau_max = 104.0f;
};

struct WalkCounts {
    int64_t rays = 0;
    int64_t bricks = 0;
    int64_t cells = 0;
};

inline void optical_depths(const Media& media, std::span<const DepthQuery> queries,
                           std::span<float> tau, WalkCounts& counts)
{
    for (size_t i = 0; i < queries.size(); ++i) {
        const DepthQuery& q = queries[i];
        tau[i] = optical_depth(media, Ray{q.o, q.d, q.time}, {0.0f, q.t1});
    }
    counts.rays += static_cast<int64_t>(queries.size());
}

}  // namespace mote
