#include "restir/direction_transmittance.h"

#include "core/parallel.h"
#include "restir/media_extent.h"
#include "restir/transmittance_map.h"

namespace mote {

DirectionTransmittance::DirectionTransmittance(const Media& media,
                                               const DirectionTransmittanceParams& params)
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
    // One band at a time: rows are then written in runs, and few maps are alive at once.
    for (int band = 0; band < hats_.bands && slots > 1; ++band) {
        std::vector<TransmittanceMap> maps;
        for (int j = 0; j < hats_.azimuths; ++j) {
            maps.emplace_back(media, hats_.centre(band * hats_.azimuths + j), map_params);
            stats_.rays += maps.back().stats().rays;
        }
        parallel_for(slots, 256, [&](size_t begin, size_t end) {
            for (size_t slot = std::max<size_t>(begin, 1); slot < end; ++slot) {
                const Vec3 x = lattice_.position(lattice_.nodes[slot]);
                float* row = rows_.data() + slot * row_size_ + band * hats_.azimuths;
                for (const TransmittanceMap& map : maps) *row++ = map.transmittance(x);
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
