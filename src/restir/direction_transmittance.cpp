#include "restir/direction_transmittance.h"

#include "core/parallel.h"
#include "restir/coarse_media.h"
#include "restir/transmittance_map.h"
#include "volumes/media_extent.h"

namespace mote {

DirectionTransmittance::DirectionTransmittance(const Media& media,
                                               const DirectionTransmittanceParams& params,
                                               const Surfaces* surfaces)
    : hats_{std::max(params.hats.bands, 1), std::max(params.hats.azimuths, 1)}
{
    const double start = process_cpu_seconds();
    const float spacing =
        params.node_spacing > 0.0f ? params.node_spacing : 4.0f * finest_voxel(media);
    lattice_ = make_smoke_lattice(media, spacing, params.node_budget);
    row_size_ = (static_cast<size_t>(hats_.count()) + 7) / 8 * 8;
    const size_t slots = lattice_.nodes.size();
    rows_.assign(slots * row_size_, 0.0f);
    std::fill_n(rows_.begin(), hats_.count(), 1.0f);

    TransmittanceMapParams map_params;
    map_params.spacing = params.map_spacing > 0.0f ? params.map_spacing : lattice_.spacing;
    // The same lines in both directions: one walk answers two.
    map_params.max_depth = infinity;
    std::vector<int> walked;
    for (int k = 0; k < hats_.count() && slots > 1; ++k) {
        if (hats_.opposite(k) < 0 || k < hats_.opposite(k)) walked.push_back(k);
    }
    // Detail below half the distance between rays would only alias.
    walked_voxel_ = 0.5f * map_params.spacing;
    walked_media_ = coarse_media(media, walked_voxel_);
    constexpr size_t batch = 12;  // maps alive at once
    for (size_t first = 0; first < walked.size(); first += batch) {
        const size_t count = std::min(batch, walked.size() - first);
        std::vector<TransmittanceMap> maps;
        for (size_t i = 0; i < count; ++i) {
            maps.emplace_back(walked_media_, hats_.centre(walked[first + i]), map_params);
            stats_.rays += maps.back().stats().rays;
        }
        // One map after the other: the part of it that these nodes see stays in the cache.
        parallel_for(slots, 256, [&](size_t begin, size_t end) {
            for (size_t i = 0; i < count; ++i) {
                const int k = walked[first + i];
                const int opposite = hats_.opposite(k);
                for (size_t slot = std::max<size_t>(begin, 1); slot < end; ++slot) {
                    const Vec3 x = lattice_.position(lattice_.nodes[slot]);
                    float* row = rows_.data() + slot * row_size_;
                    row[k] = maps[i].transmittance(x);
                    if (opposite >= 0) row[opposite] = std::exp(-maps[i].depth_behind(x));
                }
            }
        });
    }
    if (surfaces) {
        parallel_for(slots, 64, [&](size_t begin, size_t end) {
            for (size_t slot = std::max<size_t>(begin, 1); slot < end; ++slot) {
                const Vec3 x = lattice_.position(lattice_.nodes[slot]);
                for (int k = 0; k < hats_.count(); ++k) {
                    float& T = rows_[slot * row_size_ + static_cast<size_t>(k)];
                    const Ray ray{x, hats_.centre(k), cache_time};
                    if (is_occluded(*surfaces, ray, {0.0f, infinity})) T = 0.0f;
                }
            }
        });
    }
    stats_.nodes = lattice_.active_count();
    stats_.bytes = static_cast<int64_t>(rows_.size() * sizeof(float)) + lattice_.memory_bytes();
    stats_.cpu_seconds = process_cpu_seconds() - start;
}

float DirectionTransmittance::transmittance(Vec3 x, Vec3 wi) const
{
    const SmokeLattice::Corners corners = lattice_.corners(x);
    const DirectionHats::Weights hat = hats_.at(wi);
    float sum = 0.0f;
    for (int n = 0; n < 8; ++n) {
        const float* T = row(corners.slot[n]);
        float along = 0.0f;
        for (int e = 0; e < 4; ++e) along += hat.weight[e] * T[hat.index[e]];
        sum += corners.weight[n] * along;
    }
    return sum;
}

}  // namespace mote
