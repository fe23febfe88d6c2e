#include "restir/environment_cache.h"

namespace mote {
namespace {

/// Whether hats of these many directions cannot follow a lobe. Both kinds are equally good around
/// g = 0.6 with 72 directions and g = 0.5 with 32.
bool is_narrow(const Phase& phase, const DirectionHats& hats)
{
    float g = std::abs(phase.g);
    if (phase.weight_b > 0.0f) g = std::max(g, std::abs(phase.g_b));
    return (1.0f - g) * std::sqrt(static_cast<float>(hats.count())) < 3.0f;
}

}  // namespace

EnvironmentCache::EnvironmentCache(std::shared_ptr<const DirectionTransmittance> transmittance,
                                   std::vector<Spectrum> radiance, const Media& media,
                                   Vec3 camera_position)
    : nodes_{std::move(transmittance), std::move(radiance), camera_position},
      phases_(list_phases(media))
{
    nodes_.radiance.resize(static_cast<size_t>(nodes_.transmittance->hats().count()));
    bake(camera_position);
}

void EnvironmentCache::bake(Vec3 camera_position)
{
    if (!nodes_.transmittance) return;
    const double start = process_cpu_seconds();
    nodes_.camera = camera_position;
    inscatter_.clear();
    stats_ = {};
    for (const Phase& phase : phases_.phases) {
        if (is_narrow(phase, nodes_.transmittance->hats())) {
            inscatter_.emplace_back(NarrowInscatter(phase, nodes_));
        } else {
            inscatter_.emplace_back(WideInscatter(phase, nodes_));
        }
        stats_.nodes += nodes_.lattice().active_count();
        stats_.bytes +=
            std::visit([](const auto& light) { return light.memory_bytes(); }, inscatter_.back());
    }
    stats_.cpu_seconds = process_cpu_seconds() - start;
}

Spectrum EnvironmentCache::inscatter(int phase, Vec3 x) const
{
    if (inscatter_.empty()) return Spectrum(0.0f);
    return std::visit([&](const auto& light) { return light.inscatter(nodes_, x); },
                      inscatter_[static_cast<size_t>(phase)]);
}

EnvironmentCache::Towards EnvironmentCache::towards(int phase, Vec3 wo, Vec3 wi) const
{
    Towards out{phase, {}, 0.0f};
    if (inscatter_.empty()) return out;
    const Inscatter& light = inscatter_[static_cast<size_t>(phase)];
    if (const auto* narrow = std::get_if<NarrowInscatter>(&light)) {
        out.hat = narrow->hats_at(wo, wi);
        out.scale = narrow->phase_at(wo, wi);
    } else {
        out.hat = nodes_.transmittance->hats().at(wi);
        out.scale = 1.0f;
    }
    return out;
}

Spectrum EnvironmentCache::directional(const Towards& towards, Vec3 x) const
{
    if (inscatter_.empty()) return Spectrum(0.0f);
    return towards.scale *
           std::visit([&](const auto& light) { return light.directional(nodes_, x, towards.hat); },
                      inscatter_[static_cast<size_t>(towards.phase)]);
}

}  // namespace mote
