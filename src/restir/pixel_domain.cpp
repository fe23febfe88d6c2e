#include "restir/pixel_domain.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "restir/incident_light.h"

namespace mote {
namespace {

/// Share of the ray's mean in-scattered light that every bin counts with at least: bounds what a
/// wrong cache can do to the contributions.
constexpr float weight_floor = 0.05f;
/// Share of all numbers that is spread evenly over the bins. What they count with by that mean
/// falls with transmittance, below what floats can tell from nothing.
constexpr float even_share = 0.01f;

void find_surface(const Scene& scene, PixelDomain& domain)
{
    domain.surface.reset();
    if (!scene.surfaces) return;
    domain.surface = intersect(*scene.surfaces, domain.ray, {0.0f, infinity});
}

}  // namespace

void make_pixel_domain(const FrameDomain& frame, const Ray& ray, PixelDomain& domain,
                       BinCounts& counts)
{
    const Scene& scene = *frame.scene;
    domain.ray = ray;
    find_surface(scene, domain);
    make_ray_bins(scene.media, ray, frame.transmittance_cut, domain.bins, counts, domain.t_end());
    domain.cdf[domain.bins.count] = 0.0f;
}

void make_pixel_domains(const FrameDomain& frame, std::span<PixelDomain> domains, BinCounts& counts)
{
    std::vector<BinQuery> queries;
    queries.reserve(domains.size());
    for (PixelDomain& domain : domains) {
        find_surface(*frame.scene, domain);
        queries.push_back({&domain.ray, domain.t_end(), &domain.bins});
    }
    make_ray_bins(frame.scene->media, queries, frame.transmittance_cut, counts);
    for (PixelDomain& domain : domains) domain.cdf[domain.bins.count] = 0.0f;
}

void weigh_bins(const FrameDomain& frame, PixelDomain& domain)
{
    const RayBins& bins = domain.bins;
    float S[RayBins::capacity + 1];
    for (int k = 0; k <= bins.count; ++k) {
        S[k] = sampled_inscatter(frame, domain.ray.at(bins.world_t(bins.s[k])), domain.wo());
    }
    weigh_bins_by(S, weight_floor, domain);
}

void weigh_bins_by(std::span<const float> S, float least, PixelDomain& domain)
{
    const RayBins& bins = domain.bins;
    float weighted = 0.0f;
    float lost = 0.0f;
    float near = 1.0f;
    for (int k = 0; k < bins.count; ++k) {
        const float depth = bins.depth_of_bin(k);
        const Vec2 weights = linear_weights(depth);
        domain.cdf[k + 1] = near * (weights.x * S[k] + weights.y * S[k + 1]);
        weighted += domain.cdf[k + 1];
        const float far = std::exp(-bins.tau[k + 1]);
        lost += near * -std::expm1(-depth);
        near = far;
    }
    // Without light anywhere any distribution will do.
    const float mean = weighted / lost;
    const bool known = mean > 0.0f && std::isfinite(mean);
    const float floor = known ? least * mean : 1.0f;
    float total = 0.0f;
    for (int k = 0; k < bins.count; ++k) {
        const float share = std::exp(-bins.tau[k]) * -std::expm1(-bins.depth_of_bin(k));
        const float own = known && domain.cdf[k + 1] > 0.0f ? domain.cdf[k + 1] : 0.0f;
        domain.cdf[k + 1] = own + floor * share;
        total += domain.cdf[k + 1];
    }
    const float even = even_share * total / static_cast<float>(bins.count);
    domain.cdf[0] = 0.0f;
    for (int k = 0; k < bins.count; ++k) {
        const float own = bins.depth_of_bin(k) > 0.0f ? domain.cdf[k + 1] + even : 0.0f;
        domain.cdf[k + 1] = domain.cdf[k] + own;
    }
}

RayPoint point_at(const FrameDomain& frame, const PixelDomain& domain, float u)
{
    RayPoint point;
    const RayBins& bins = domain.bins;
    const float Z = domain.Z();
    if (!(Z > 0.0f)) return point;
    const float goal = u * Z;
    const float* cdf = domain.cdf;
    const auto above = std::upper_bound(cdf + 1, cdf + bins.count, goal) - cdf;
    const int k = static_cast<int>(above) - 1;
    const float width = cdf[k + 1] - cdf[k];
    const float depth = bins.depth_of_bin(k);
    if (!(width > 0.0f) || !(depth > 0.0f)) return point;
    const float r = std::clamp((goal - cdf[k]) / width, 0.0f, one_minus_epsilon);
    const float lost = -std::expm1(-depth);
    const float tau = -std::log1p(-r * lost);
    point.bin = k;
    point.s = invert_bin(frame.scene->media, domain.ray, bins, k, tau);
    point.x = domain.ray.at(bins.world_t(point.s));
    point.weight = Z * std::exp(-bins.tau[k]) * lost / width;
    return point;
}

std::optional<RayNumber> number_at(const FrameDomain& frame, const PixelDomain& domain, float s)
{
    const RayBins& bins = domain.bins;
    const float Z = domain.Z();
    if (!(Z > 0.0f) || !(s >= bins.s[0]) || !(s <= bins.s[bins.count])) return std::nullopt;
    const int k = bin_of(bins, s);
    const float depth = bins.depth_of_bin(k);
    const float width = domain.cdf[k + 1] - domain.cdf[k];
    const float sigma_t =
        sigma_t_at(frame.scene->media, domain.ray.at(bins.world_t(s)), domain.ray.time);
    if (!(width > 0.0f) || !(depth > 0.0f) || !(sigma_t > 0.0f)) return std::nullopt;
    const float tau = depth_to(frame.scene->media, domain.ray, bins, s) - bins.tau[k];
    const float lost = -std::expm1(-depth);
    const float r = std::clamp(-std::expm1(-tau) / lost, 0.0f, one_minus_epsilon);
    const float u = (domain.cdf[k] + r * width) / Z;
    return RayNumber{std::min(u, one_minus_epsilon), sigma_t * std::exp(-tau) * width / (lost * Z)};
}

}  // namespace mote
