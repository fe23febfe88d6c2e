#include "volumes/ray_table.h"

#include <algorithm>
#include <cmath>

#include "volumes/collisions.h"

namespace mote {

RayTable::RayTable(const Volume& volume, const Ray& ray, Interval range)
    : grid_(volume.density.get()), scale_(static_cast<double>(volume.density_scale))
{
    if (!grid_ || !(scale_ > 0.0)) return;
    ray_ = make_local_ray(*grid_, frames_at(volume, ray.time).density, ray, range);
    for_each_brick(*grid_, ray_, [&](const BrickSpan& span) {
        depth_ += scale_ * static_cast<double>(integrate_brick(*grid_, ray_, span));
        entries_.push_back({span, depth_});
        return true;
    });
}

double RayTable::depth_to(float t) const
{
    const float s = static_cast<float>(static_cast<double>(t) - ray_.t0);
    const auto entry =
        std::lower_bound(entries_.begin(), entries_.end(), s,
                         [](const Entry& e, float value) { return e.span.s1 <= value; });
    const double before = entry == entries_.begin() ? 0.0 : (entry - 1)->end;
    if (entry == entries_.end() || s <= entry->span.s0) return before;
    BrickSpan part = entry->span;
    part.s1 = s;
    return before + scale_ * static_cast<double>(integrate_brick(*grid_, ray_, part));
}

std::optional<float> RayTable::distance_at(double tau) const
{
    const auto entry = std::upper_bound(entries_.begin(), entries_.end(), tau,
                                        [](double value, const Entry& e) { return value < e.end; });
    if (entry == entries_.end()) return std::nullopt;
    const double before = entry == entries_.begin() ? 0.0 : (entry - 1)->end;
    auto left = static_cast<float>(tau - before);
    const float s = invert_brick(*grid_, ray_, entry->span, static_cast<float>(scale_), left);
    return ray_.world_t(s < 0.0f ? entry->span.s1 : s);
}

std::optional<float> RayTable::sample(float u) const
{
    return distance_at(-std::log1p(-static_cast<double>(u)));
}

std::optional<float> RayTable::sample_collision(float u) const
{
    if (!(depth_ > 0.0)) return std::nullopt;
    const double hit = -std::expm1(-depth_);
    const double tau = -std::log1p(-static_cast<double>(u) * hit);
    return distance_at(tau);  // below the whole depth: u has 24 bits, tau more
}

float RayTable::pdf(float t) const
{
    if (entries_.empty()) return 0.0f;
    const Vec3 p = ray_.at(static_cast<float>(static_cast<double>(t) - ray_.t0));
    const double sigma_t = scale_ * static_cast<double>(sample_local(*grid_, p));
    return static_cast<float>(sigma_t * std::exp(-depth_to(t)));
}

}  // namespace mote
