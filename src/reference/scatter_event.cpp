#include "reference/scatter_event.h"

namespace mote {
namespace {

std::optional<ScatteredDirection> sample_towards(const ScatterEvent& event, Vec3 wo, Rng& rng)
{
    if (event.surface) {
        const std::optional<BsdfSample> s = sample_bsdf(*event.surface, wo, rng.uniform3());
        if (!s) return std::nullopt;
        return ScatteredDirection{s->wi, {s->value.cosine * s->value.f, s->value.pdf_dir}};
    }
    const Vec3 wi = sample_phase(*event.phase, wo, rng.uniform2());
    const float phase = phase_pdf(*event.phase, wo, wi);
    return ScatteredDirection{wi, {Spectrum(phase), phase}};
}

}  // namespace

std::optional<ScatteredDirection> sample_scattering(const ScatterEvent& event, Rng& rng)
{
    if (!event.mixture) return sample_towards(event, event.wo, rng);
    const WayMixture& mixture = *event.mixture;
    float u = rng.uniform();
    size_t chosen = 0;
    for (size_t i = 0; i < mixture.wo.size(); ++i) {
        if (!(mixture.share[i] > 0.0f)) continue;
        chosen = i;
        u -= mixture.share[i];
        if (u < 0.0f) break;
    }
    std::optional<ScatteredDirection> s = sample_towards(event, mixture.wo[chosen], rng);
    if (!s) return std::nullopt;
    s->scattering = eval_scattering(event, s->wi);
    return s;
}

}  // namespace mote
