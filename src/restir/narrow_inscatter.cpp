#include "restir/narrow_inscatter.h"

#include "core/parallel.h"

namespace mote {
namespace {

Vec3 direction_or(Vec3 from, Vec3 to, Vec3 otherwise)
{
    const Vec3 d = to - from;
    const float squared = glm::dot(d, d);
    return squared > 1e-30f ? d / std::sqrt(squared) : otherwise;
}

Vec3 middle_of(const SmokeLattice& lattice)
{
    return lattice.origin + 0.5f * lattice.spacing * Vec3(lattice.count - 1);
}

}  // namespace

NarrowInscatter::NarrowInscatter(const Phase& phase, const EnvironmentNodes& nodes)
    : phase_(phase),
      hats_(phase, nodes.transmittance->hats()),
      table_(nodes.transmittance->hats()),
      frames_(direction_or(nodes.camera, middle_of(nodes.lattice()), Vec3(0.0f, 0.0f, -1.0f)))
{
    const SmokeLattice& lattice = nodes.lattice();
    const auto count = static_cast<size_t>(hats_.count());
    inscatter_.resize(lattice.nodes.size());
    light_.resize(lattice.nodes.size() * count);
    parallel_for(lattice.nodes.size(), 64, [&](size_t begin, size_t end) {
        for (size_t slot = std::max<size_t>(begin, 1); slot < end; ++slot) {
            const Vec3 position = lattice.position(lattice.nodes[slot]);
            const Mat3 frame = frames_.at(view_direction(nodes, position));
            const float* row = nodes.transmittance->row(static_cast<int32_t>(slot));
            Spectrum sum(0.0f);
            for (int j = 0; j < hats_.count(); ++j) {
                const Spectrum light = light_at(nodes, frame, j, row);
                light_[slot * count + static_cast<size_t>(j)] = light;
                sum += light;
            }
            inscatter_[slot] = PaddedSpectrum(sum / static_cast<float>(hats_.count()));
        }
    });
}

int64_t NarrowInscatter::memory_bytes() const
{
    return static_cast<int64_t>(light_.size() * sizeof(Spectrum) +
                                inscatter_.size() * sizeof(PaddedSpectrum));
}

Vec3 NarrowInscatter::view_direction(const EnvironmentNodes& nodes, Vec3 x) const
{
    return direction_or(nodes.camera, x, frames_.middle());
}

Spectrum NarrowInscatter::light_at(const EnvironmentNodes& nodes, const Mat3& frame, int j,
                                   const float* transmittance) const
{
    const DirectionHats::Weights& hat = table_.at(frame * hats_.centre(j));
    Spectrum sum(0.0f);
    for (int e = 0; e < 4; ++e) {
        const auto k = static_cast<size_t>(hat.index[e]);
        sum += hat.weight[e] * transmittance[k] * nodes.radiance[k];
    }
    return sum;
}

Spectrum NarrowInscatter::inscatter(const EnvironmentNodes& nodes, Vec3 x) const
{
    return interpolate_nodes(nodes.lattice(), inscatter_, x, [&](Vec3 position) {
        const Mat3 frame = frames_.at(view_direction(nodes, position));
        Spectrum sum(0.0f);
        for (int j = 0; j < hats_.count(); ++j) {
            sum += light_at(nodes, frame, j, nodes.transmittance->row(0));
        }
        return sum / static_cast<float>(hats_.count());
    });
}

Spectrum NarrowInscatter::directional(const EnvironmentNodes& nodes, Vec3 x,
                                      const DirectionHats::Weights& hat) const
{
    const SmokeLattice& lattice = nodes.lattice();
    const SmokeLattice::Corners corners = lattice.corners(x);
    Spectrum sum(0.0f);
    for (int n = 0; n < 8; ++n) {
        Spectrum light(0.0f);
        if (corners.slot[n] != 0) {
            const Spectrum* row = light_.data() + static_cast<size_t>(corners.slot[n]) *
                                                      static_cast<size_t>(hats_.count());
            for (int e = 0; e < 4; ++e) light += hat.weight[e] * row[hat.index[e]];
        } else if (corners.weight[n] > 0.0f) {  // never in smoke, and slow
            const Vec3 position = lattice.position(corners.node(n));
            const Mat3 there = frames_.at(view_direction(nodes, position));
            for (int e = 0; e < 4; ++e) {
                light += hat.weight[e] *
                         light_at(nodes, there, hat.index[e], nodes.transmittance->row(0));
            }
        }
        sum += corners.weight[n] * light;
    }
    return sum;
}

}  // namespace mote
