#include "restir/combine.h"

#include <cmath>

namespace mote {
namespace {

void ask(LightRays& rays, size_t owner, const Candidate& c, float time, float scale)
{
    rays.add(static_cast<int>(owner), c.x, c.arrival.wi, c.arrival.distance, time, scale * c.f,
             infinity);  // targets are compared between pixels: no ray may end early
}

/// What a target knows of a candidate's shadow without a ray.
float known_visibility(TargetVisibility visibility, const FrameDomain& frame, const Candidate& c)
{
    if (visibility != TargetVisibility::Cached || !(max_component(c.f) > 0.0f)) return 1.0f;
    return cached_visibility(frame, c.y, c.x, c.arrival);
}

}  // namespace

PixelReservoir resample(std::span<const Candidate> candidates, Rng& rng, Spectrum& color)
{
    RisStream stream;
    stream.count(1.0f);
    PixelReservoir out;
    color = Spectrum(0.0f);
    for (const Candidate& c : candidates) {
        const float p_hat = c.known * luminance(c.f);
        color += c.f / c.density;
        const double w = static_cast<double>(p_hat) / static_cast<double>(c.density);
        if (stream.add(c.y, p_hat, w, 0.0f, rng.uniform())) out.f = c.f;
    }
    out.r = stream.finish();
    return out;
}

void Combination::clear()
{
    pixels_.clear();
    others_.clear();
    here_.clear();
    there_.clear();
}

int Combination::begin_pixel(const PixelReservoir& own)
{
    pixels_.push_back({&own, others_.size(), 0});
    return static_cast<int>(pixels_.size()) - 1;
}

std::optional<Combination::Shifted> Combination::shifted(const PathSample& y, const ShiftEnd& from,
                                                         const ShiftEnd& to,
                                                         const RayMap& map) const
{
    const std::optional<ShiftedSample> sample = shift(rules_.shift, y, from, to, map);
    if (!sample) return std::nullopt;
    Shifted out{evaluate(to.frame, to.domain, sample->y), sample->jacobian, to.domain.ray.time};
    out.c.known = known_visibility(rules_.visibility, to.frame, out.c);
    return out;
}

void Combination::add_other(const ShiftEnd& own, const ShiftEnd& from, const Reservoir& other,
                            float confidence, const RayMap& map)
{
    const Reservoir& mine = pixels_.back().own->r;
    std::optional<Shifted> here;
    std::optional<Shifted> own_there;
    if (other.W > 0.0f) here = shifted(other.y, from, own, map);
    if (mine.W > 0.0f) own_there = shifted(mine.y, own, from, map.inverse());
    add(other, confidence, here, own_there);
}

void Combination::add_other(const SurfaceEnd& own, const SurfaceEnd& from, const Reservoir& other,
                            float confidence)
{
    const auto taken = [&](const Reservoir& r, const SurfaceEnd& a,
                           const SurfaceEnd& b) -> std::optional<Shifted> {
        if (!(r.W > 0.0f) || !has_equal_measure(a.frame, b.frame, r.y.light)) return std::nullopt;
        Shifted out{evaluate(b.frame, b.domain, r.y), 1.0f, b.domain.time};
        out.c.known = known_visibility(rules_.visibility, b.frame, out.c);
        return out;
    };
    add(other, confidence, taken(other, from, own), taken(pixels_.back().own->r, own, from));
}

void Combination::add(const Reservoir& other, float confidence, const std::optional<Shifted>& here,
                      const std::optional<Shifted>& own_there)
{
    Pixel& pixel = pixels_.back();
    const size_t index = others_.size();
    Other& out = others_.emplace_back();
    ++pixel.count;
    out.p_hat_there = other.p_hat;
    out.W = other.W;
    out.M = confidence;
    out.age = other.age;
    const bool asks = rules_.visibility == TargetVisibility::Exact;
    if (here) {
        out.y = here->c.y;
        out.jacobian = here->jacobian;
        out.f = here->c.f;
        out.shadow = here->c.known;
        if (asks) ask(here_, index, here->c, here->time, 1.0f);
    }
    if (own_there) {
        const Candidate& c = own_there->c;
        out.own_there = own_there->jacobian * c.known * luminance(c.f);
        if (asks) ask(there_, index, c, own_there->time, own_there->jacobian);
    }
}

void Combination::trace(const Scene& here, const Scene& there, WalkCounts& counts)
{
    if (rules_.visibility != TargetVisibility::Exact) return;
    for (Other& other : others_) other.shadow = other.own_there = 0.0f;
    here_.trace(here, counts);
    for (size_t i = 0; i < here_.size(); ++i) {
        others_[static_cast<size_t>(here_.owners[i])].shadow = std::exp(-here_.depths[i]);
    }
    there_.trace(there, counts);
    for (size_t i = 0; i < there_.size(); ++i) {
        others_[static_cast<size_t>(there_.owners[i])].own_there = luminance(there_.value(i));
    }
}

PixelReservoir Combination::finish(int index, Rng& rng, Spectrum& color) const
{
    const Pixel& pixel = pixels_[static_cast<size_t>(index)];
    const Reservoir& mine = pixel.own->r;
    Confidences c{mine.M, 0.0f};
    for (size_t i = 0; i < pixel.count; ++i) c.others += others_[pixel.first + i].M;
    RisStream stream;
    stream.count(c.sum());
    PixelReservoir out;
    color = Spectrum(0.0f);

    float m_0 = own_weight_base(rules_.mis, c);
    for (size_t i = 0; i < pixel.count; ++i) {
        const Other& other = others_[pixel.first + i];
        m_0 += own_weight_term(rules_.mis, c, other.M, other.own_there, mine.p_hat);
    }
    const double w_0 =
        static_cast<double>(m_0) * static_cast<double>(mine.p_hat) * static_cast<double>(mine.W);
    if (mine.W > 0.0f && m_0 > 0.0f) color += (m_0 * mine.W) * pixel.own->f;
    if (stream.add(mine.y, mine.p_hat, w_0, mine.age, rng.uniform())) out.f = pixel.own->f;

    for (size_t i = 0; i < pixel.count; ++i) {
        const Other& other = others_[pixel.first + i];
        const Spectrum f = other.shadow * other.f;
        const float p_hat = luminance(f);
        const float u = rng.uniform();
        if (!(p_hat > 0.0f) || !(other.jacobian > 0.0f)) continue;
        // The other's own target at this sample, pulled back: known without another evaluation.
        const float pulled_back = other.p_hat_there / other.jacobian;
        const float m = other_weight(rules_.mis, c, other.M, pulled_back, p_hat);
        const float weight = m * other.W * other.jacobian;
        if (!(weight > 0.0f) || !std::isfinite(weight)) continue;
        color += weight * f;
        const double w = static_cast<double>(weight) * static_cast<double>(p_hat);
        if (stream.add(other.y, p_hat, w, other.age, u)) out.f = f;
    }
    out.r = stream.finish();
    return out;
}

}  // namespace mote
