#include "multiscatter/shared_paths.h"

#include <algorithm>
#include <cmath>

#include "multiscatter/gather_light.h"
#include "multiscatter/near_lamps.h"
#include "multiscatter/send_paths.h"
#include "volumes/media_extent.h"

namespace mote {

PathSharing sharing_for(const Media& media, float mean_events)
{
    constexpr float many_events = 64.0f;
    constexpr float narrow_lobe = 0.8f;
    const bool is_narrow =
        std::any_of(media.volumes.begin(), media.volumes.end(), [](const Volume& volume) {
            const Phase& phase = volume.phase;
            return std::abs(phase.g + phase.weight_b * (phase.g_b - phase.g)) >= narrow_lobe;
        });
    PathSharing sharing;
    if (mean_events < many_events || !is_narrow) return sharing;
    sharing.group_size *= 2;
    ++sharing.levels;
    return sharing;
}

void share_paths(const TraceContext& trace, const CoarseExtinction& extinction,
                 const PathSharing& sharing, std::vector<PathVertex> first, Rng& rng,
                 std::span<Spectrum> light, WalkCounts& counts, float& cut)
{
    // With surfaces every member of a group asks whether it sees what another one has found.
    const int group_size = trace.scene.surfaces ? sharing.group_size / 4 : sharing.group_size;
    const SharingContext context{trace,
                                 extinction,
                                 static_cast<size_t>(std::max(1, group_size)),
                                 cache_time,
                                 counts,
                                 cut,
                                 has_small_lamps(trace.scene) ? sharing.near_share : 0.0f,
                                 sharing.known};
    const int last = std::min(sharing.levels, trace.params.max_bounces - 1);
    std::vector<PathLevel> levels(static_cast<size_t>(last) + 1);
    levels.front().vertices = std::move(first);
    for (int l = 0; l < last; ++l) {
        const auto at = static_cast<size_t>(l);
        send_paths(context, l + 1, l == 0, levels[at], levels[at + 1], rng);
    }
    PathLevel& end = levels.back();
    for (PathVertex& v : end.vertices) {
        if (v.surface >= 0 || !v.goes_on) continue;
        follow_own_path(context, end.event(v, context.time), last + 1, v, rng);
    }
    for (int l = last - 1; l >= 0; --l) {
        const auto at = static_cast<size_t>(l);
        gather_light(context, levels[at], levels[at + 1], rng,
                     l == 0 ? light : std::span<Spectrum>());
    }
}

}  // namespace mote
