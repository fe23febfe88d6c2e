#include "multiscatter/mean_radiance.h"

#include <algorithm>

namespace mote {
namespace {

constexpr float mean_of_order_0 = 0.28209479f;  ///< sqrt(1 / (4 pi)), of its coefficient
/// Each doubles the variance of the kernel, of 1, 2, 1 along each axis.
constexpr int smoothings = 4;

/// Mean of the active nodes around each, in proportion to 1, 1/2, 1/4 and 1/8 by their distance.
std::vector<Spectrum> smooth(const SmokeLattice& lattice, const std::vector<Spectrum>& values)
{
    std::vector<Spectrum> out(values.size(), Spectrum(0.0f));
    for (size_t slot = 1; slot < values.size(); ++slot) {
        const Vec3i node = lattice.nodes[slot];
        float weights = 0.0f;
        for (int n = 0; n < 27; ++n) {
            const Vec3i step(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
            const Vec3i other = node + step;
            if (glm::any(glm::lessThan(other, Vec3i(0))) ||
                glm::any(glm::greaterThanEqual(other, lattice.count))) {
                continue;
            }
            const int32_t from = lattice.slots[lattice.index(other)];
            if (from == 0) continue;
            const Vec3i away = glm::abs(step);
            const float weight = 1.0f / static_cast<float>(1 << (away.x + away.y + away.z));
            out[slot] += weight * values[static_cast<size_t>(from)];
            weights += weight;
        }
        out[slot] /= weights;
    }
    return out;
}

}  // namespace

std::optional<Spectrum> MeanRadiance::known_at(Vec3 x) const
{
    const SmokeLattice::Corners corners = lattice.corners(x);
    Spectrum sum(0.0f);
    float weights = 0.0f;
    for (int n = 0; n < 8; ++n) {
        if (corners.slot[n] == 0) continue;
        sum += corners.weight[n] * values[static_cast<size_t>(corners.slot[n])];
        weights += corners.weight[n];
    }
    if (!(weights > 0.0f)) return std::nullopt;
    return sum / weights;
}

MeanRadiance mean_radiance(RadianceCache cache)
{
    MeanRadiance mean;
    mean.lattice = std::move(cache.lattice);
    mean.values.reserve(cache.incident.size());
    for (const RadianceCache::Node& node : cache.incident) {
        const Spectrum value = mean_of_order_0 * node[0];
        mean.values.push_back(is_finite(value) ? value : Spectrum(0.0f));
    }
    for (int i = 0; i < smoothings; ++i) mean.values = smooth(mean.lattice, mean.values);
    return mean;
}

void blend_in(const MeanRadiance& before, int most_frames, MeanRadiance& now)
{
    const int frames = std::min(before.frames, most_frames);
    const float share = 1.0f / static_cast<float>(frames + 1);
    for (size_t slot = 1; slot < now.values.size(); ++slot) {
        const std::optional<Spectrum> known =
            before.known_at(now.lattice.position(now.lattice.nodes[slot]));
        if (known) now.values[slot] = *known + share * (now.values[slot] - *known);
    }
    now.frames = frames + 1;
}

}  // namespace mote
