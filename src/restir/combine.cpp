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
    sites_.clear();
    targets_.clear();
    chosen_.clear();
    here_.clear();
    there_.clear();
    target_rays_.clear();
}

int Combination::begin_pixel(const PixelReservoir& own)
{
    pixels_.push_back({&own, others_.size(), 0, 0});
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
    if (mine.W > 0.0f && compares_targets(rules_.mis)) {
        own_there = shifted(mine.y, own, from, map.inverse());
    }
    add(other, confidence, here, own_there);
}

std::optional<Combination::Shifted> Combination::taken(const PathSample& y, const FrameDomain& from,
                                                       const SurfaceEnd& to) const
{
    if (!has_equal_measure(from, to.frame, y.light)) return std::nullopt;
    Shifted out{evaluate(to.frame, to.domain, y), 1.0f, to.domain.time};
    out.c.known = known_visibility(rules_.visibility, to.frame, out.c);
    return out;
}

void Combination::add_other(const SurfaceEnd& own, const SurfaceEnd& from, const Reservoir& other,
                            float confidence)
{
    const Reservoir& mine = pixels_.back().own->r;
    std::optional<Shifted> here;
    std::optional<Shifted> own_there;
    if (other.W > 0.0f) here = taken(other.y, from.frame, own);
    if (mine.W > 0.0f && compares_targets(rules_.mis)) own_there = taken(mine.y, own.frame, from);
    sites_.push_back({&own.frame, &from.frame, &from.domain});
    add(other, confidence, here, own_there);
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
    out.V = other.V;
    if (here) {
        out.y = here->c.y;
        out.jacobian = here->jacobian;
        out.f = here->c.f;
        out.shadow = here->c.known;
        if (knows_all() || rules_.traces_V) ask(here_, index, here->c, here->time, 1.0f);
    }
    if (own_there) {
        const Candidate& c = own_there->c;
        out.own_there = own_there->jacobian * c.known * luminance(c.f);
        if (knows_all()) ask(there_, index, c, own_there->time, own_there->jacobian);
    }
}

void Combination::trace(const Scene& here, const Scene& there, WalkCounts& counts)
{
    for (Other& other : others_) {
        if (knows_all()) other.shadow = other.own_there = 0.0f;
        if (rules_.traces_V) other.V = 0.0f;
    }
    here_.trace(here, counts);
    for (size_t i = 0; i < here_.size(); ++i) {
        Other& other = others_[static_cast<size_t>(here_.owners[i])];
        (knows_all() ? other.shadow : other.V) = std::exp(-here_.depths[i]);
    }
    there_.trace(there, counts);
    for (size_t i = 0; i < there_.size(); ++i) {
        others_[static_cast<size_t>(there_.owners[i])].own_there = luminance(there_.value(i));
    }
    if (rules_.mis == MisForm::Balance) {
        ask_crosses();
        trace_targets(there, counts);
    }
}

void Combination::ask_target(const PathSample& y, size_t other, size_t slot)
{
    const Site& site = sites_[other];
    const std::optional<Shifted> there = taken(y, *site.own, {*site.frame, *site.domain});
    if (!there) return;
    if (knows_all()) {
        ask(target_rays_, slot, there->c, there->time, 1.0f);
    } else {
        targets_[slot] = there->c.known * luminance(there->c.f);
    }
}

void Combination::ask_crosses()
{
    for (Pixel& pixel : pixels_) {
        if (pixel.count < 2) continue;
        MOTE_ASSERT(sites_.size() == others_.size());
        pixel.first_cross = targets_.size();
        targets_.resize(targets_.size() + pixel.count * pixel.count, 0.0f);
        for (size_t i = 0; i < pixel.count; ++i) {
            const Other& other = others_[pixel.first + i];
            if (!(other.p_hat() > 0.0f)) continue;  // is never chosen
            for (size_t j = 0; j < pixel.count; ++j) {
                if (j == i) continue;
                ask_target(other.y, pixel.first + j, pixel.first_cross + i * pixel.count + j);
            }
        }
    }
}

void Combination::trace_targets(const Scene& there, WalkCounts& counts)
{
    target_rays_.trace(there, counts);
    for (size_t i = 0; i < target_rays_.size(); ++i) {
        targets_[static_cast<size_t>(target_rays_.owners[i])] = luminance(target_rays_.value(i));
    }
}

}  // namespace mote
