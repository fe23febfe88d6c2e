#include "restir/combine.h"

#include <cmath>

namespace mote {
namespace {

/// Targets are compared between pixels, so their shadow rays end nowhere before floats do.
constexpr float whole_depth = 104.0f;

void ask(LightRays& rays, size_t owner, const Candidate& c, float time, float scale)
{
    rays.add(static_cast<int>(owner), c.x, c.arrival.wi, c.arrival.distance, time, scale * c.f,
             whole_depth);
}

}  // namespace

PixelReservoir resample(std::span<const Candidate> candidates, Rng& rng, Spectrum& color)
{
    RisStream stream;
    stream.count(1.0f);
    PixelReservoir out;
    color = Spectrum(0.0f);
    for (const Candidate& c : candidates) {
        const float p_hat = luminance(c.f);
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

void Combination::add_other(const ShiftEnd& own, const ShiftEnd& from, const Reservoir& other,
                            float confidence, const RayMap& map)
{
    Pixel& pixel = pixels_.back();
    const size_t index = others_.size();
    Other& out = others_.emplace_back();
    ++pixel.count;
    out.p_hat_there = other.p_hat;
    out.W = other.W;
    out.M = confidence;
    out.age = other.age;
    if (other.W > 0.0f) {
        if (const auto shifted = shift(rules_.shift, other.y, from, own, map)) {
            const Candidate c = evaluate(own.frame, own.domain, shifted->y);
            out.y = shifted->y;
            out.jacobian = shifted->jacobian;
            out.f = c.f;
            ask(here_, index, c, own.domain.ray.time, 1.0f);
        }
    }
    const Reservoir& mine = pixel.own->r;
    if (mine.W > 0.0f) {
        if (const auto shifted = shift(rules_.shift, mine.y, own, from, map.inverse())) {
            const Candidate c = evaluate(from.frame, from.domain, shifted->y);
            ask(there_, index, c, from.domain.ray.time, shifted->jacobian);
        }
    }
}

void Combination::trace(const Media& here, const Media& there, WalkCounts& counts)
{
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
