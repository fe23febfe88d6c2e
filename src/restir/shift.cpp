#include "restir/shift.h"

#include <algorithm>
#include <cmath>

namespace mote {
namespace {

float collided_share(const RayBins& bins)
{
    return -std::expm1(-bins.depth());
}

std::optional<ShiftedNumber> shift_world(float u, const ShiftEnd& from, const ShiftEnd& to,
                                         const RayMap& map)
{
    if (!map.is_usable()) return std::nullopt;
    const RayPoint point = point_at(from.frame, from.domain, u);
    if (!(point.weight > 0.0f)) return std::nullopt;
    const std::optional<RayNumber> here = number_at(from.frame, from.domain, point.s);
    const double t = from.domain.bins.t0 + static_cast<double>(point.s);
    const double t_to = map.offset + static_cast<double>(map.slope) * t;
    const auto s_to = static_cast<float>(t_to - to.domain.bins.t0);
    const std::optional<RayNumber> there = number_at(to.frame, to.domain, s_to);
    if (!here || !there) return std::nullopt;
    const float jacobian = map.slope * there->density / here->density;
    if (!(jacobian > 0.0f) || !std::isfinite(jacobian)) return std::nullopt;
    return ShiftedNumber{there->u, jacobian};
}

std::optional<ShiftedNumber> shift_fraction(float u, const ShiftEnd& from, const ShiftEnd& to)
{
    const RayPoint point = point_at(from.frame, from.domain, u);
    const float lost = collided_share(from.domain.bins);
    const float lost_to = collided_share(to.domain.bins);
    if (!(point.weight > 0.0f) || !(to.domain.Z() > 0.0f)) return std::nullopt;
    const float tau = depth_to(from.frame.scene->media, from.domain.ray, from.domain.bins, point.s);
    const float F = std::min(-std::expm1(-tau) / lost, one_minus_epsilon);
    const float tau_to = -std::log1p(-F * lost_to);
    // Both distributions are proportional to sigma_t T inside a bin, so u' needs no lookup.
    const RayBins& bins = to.domain.bins;
    const auto above = std::upper_bound(bins.tau + 1, bins.tau + bins.count, tau_to) - bins.tau;
    const int k = static_cast<int>(above) - 1;
    const float width = to.domain.cdf[k + 1] - to.domain.cdf[k];
    const float bin_lost = -std::expm1(-bins.depth_of_bin(k));
    if (!(width > 0.0f)) return std::nullopt;  // as of bins without depth
    const float r = -std::expm1(-(tau_to - bins.tau[k])) / bin_lost;
    const float u_to = std::min((to.domain.cdf[k] + r * width) / to.domain.Z(), one_minus_epsilon);
    const float weight_to = to.domain.Z() * std::exp(-bins.tau[k]) * bin_lost / width;
    return ShiftedNumber{u_to, point.weight / weight_to * lost_to / lost};
}

}  // namespace

bool has_equal_measure(const FrameDomain& from, const FrameDomain& to, int light)
{
    const auto i = static_cast<size_t>(light);
    return light >= 0 && i < from.lights.size() && i < to.lights.size() &&
           from.lights[i].kind == to.lights[i].kind;
}

RayMap make_ray_map(const Ray& from, const Ray& to, Vec3 motion)
{
    const Vec3d offset = Vec3d(from.o) + Vec3d(motion) - Vec3d(to.o);
    return {glm::dot(offset, Vec3d(to.d)), glm::dot(from.d, to.d)};
}

std::optional<ShiftedNumber> shift_number(ShiftKind kind, float u, const ShiftEnd& from,
                                          const ShiftEnd& to, const RayMap& map)
{
    switch (kind) {
        case ShiftKind::RandomNumbers:
            if (!(from.domain.Z() > 0.0f) || !(to.domain.Z() > 0.0f)) return std::nullopt;
            return ShiftedNumber{u, 1.0f};
        case ShiftKind::World:
            return shift_world(u, from, to, map);
        case ShiftKind::Fraction:
            return shift_fraction(u, from, to);
    }
    return std::nullopt;
}

std::optional<ShiftedSample> shift(ShiftKind kind, const PathSample& y, const ShiftEnd& from,
                                   const ShiftEnd& to, const RayMap& map)
{
    if (!has_equal_measure(from.frame, to.frame, y.light)) return std::nullopt;
    const std::optional<ShiftedNumber> number = shift_number(kind, y.u, from, to, map);
    if (!number) return std::nullopt;
    return ShiftedSample{{number->u, y.light, y.v}, number->jacobian};
}

}  // namespace mote
