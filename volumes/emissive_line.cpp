#include "volumes/emissive_line.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "volumes/brick_walk.h"
#include "volumes/local_ray.h"

namespace mote {
namespace {

/// Part of a ray in one emissive brick. Distances in it fall off exponentially.
struct EmissiveSpan {
    float t0 = 0.0f;
    float length = 0.0f;
    float rate = 0.0f;    ///< [1/m]
    float weight = 0.0f;  ///< the light that arrives, up to a factor common to all

    /// Share of the distances before that at `depth` metres into the span, unnormalised.
    [[nodiscard]] float before(float depth) const
    {
        return rate > 0.0f ? -std::expm1(-rate * depth) / rate : depth;
    }
    [[nodiscard]] float pdf(float t) const
    {
        const float depth = t - t0;
        if (!(depth >= 0.0f && depth < length)) return 0.0f;
        return std::exp(-rate * depth) / before(length);
    }
    [[nodiscard]] float distance(float u) const
    {
        const float share = u * before(length);
        return t0 + (rate > 0.0f ? -std::log1p(-share * rate) / rate : share);
    }
};

/// Means say little about what stands in the way: neither a brick far inside nor a brick's far end
/// may become unlikely for their sake.
constexpr float deepest = 4.0f;
constexpr float steepest = 2.0f;

/// Mean optical depths along a ray, at the far ends of its bricks.
class CoarseDepth {
  public:
    void add(float t1, float depth)
    {
        total_ += depth;
        ends_.push_back({t1, total_});
    }
    /// Before the brick that holds t.
    [[nodiscard]] float at(float t) const
    {
        const auto next = std::partition_point(ends_.begin(), ends_.end(),
                                               [&](const End& end) { return end.t <= t; });
        return next == ends_.begin() ? 0.0f : std::prev(next)->tau;
    }
    [[nodiscard]] float total() const { return total_; }

  private:
    struct End {
        float t;
        float tau;
    };
    std::vector<End> ends_;
    float total_ = 0.0f;
};

EmissiveSpan make_span(float t0, float t1, float sigma_t, float tau, float emission)
{
    EmissiveSpan span{t0, t1 - t0, 0.0f, 0.0f};
    span.rate = span.length > 0.0f ? std::min(sigma_t, steepest / span.length) : 0.0f;
    span.weight = emission * std::exp(-std::min(tau, deepest)) * span.before(span.length);
    return span;
}

/// Mean emission of a brick, up to a factor common to all of the volume.
float emission_of(const EmissiveBricks::Part& part, const BrickSpan& span)
{
    const Vec3i c(span.origin / static_cast<float>(BrickGrid::brick_size) + 0.5f);
    const float pmf = part.pmf[part.grid->table_index(c.x, c.y, c.z)];
    return static_cast<float>(static_cast<double>(pmf) / part.brick_volume);
}

/// Calls f for every emissive brick on the ray: those of the density grid, then those of the
/// emission grid.
template <class F>
void for_each_emissive_span(const Volume& volume, const EmissiveBricks& bricks, const Ray& ray,
                            F&& f)
{
    const EmissiveBricks::Part& glow = bricks.parts[0];
    const EmissiveBricks::Part& gas = bricks.parts[1];
    CoarseDepth depth;
    if (!is_void(volume)) {
        const BrickGrid& grid = *volume.density;
        const LocalRay local = density_ray(volume, ray, {0.0f, infinity});
        for_each_brick(grid, local, [&](const BrickSpan& span) {
            const float t0 = local.world_t(span.s0);
            const float t1 = local.world_t(span.s1);
            const float sigma_t =
                volume.density_scale * grid.ranges[static_cast<size_t>(span.brick)].mean;
            const float emission = glow.grid ? emission_of(glow, span) : 0.0f;
            if (emission > 0.0f) f(make_span(t0, t1, sigma_t, depth.total(), emission));
            depth.add(t1, sigma_t * (t1 - t0));
            return true;
        });
    }
    if (!gas.grid) return;
    const LocalRay local =
        make_local_ray(*gas.grid, frames_at(volume, ray.time).emission, ray, {0.0f, infinity});
    for_each_brick(*gas.grid, local, [&](const BrickSpan& span) {
        const float emission = emission_of(gas, span);
        const float t0 = local.world_t(span.s0);
        if (emission > 0.0f) {
            f(make_span(t0, local.world_t(span.s1), 0.0f, depth.at(t0), emission));
        }
        return true;
    });
}

}  // namespace

std::optional<LineSample> sample_emissive_line(const Volume& volume, const EmissiveBricks& bricks,
                                               const Ray& ray, float u)
{
    float sum = 0.0f;
    EmissiveSpan chosen;
    for_each_emissive_span(volume, bricks, ray, [&](const EmissiveSpan& span) {
        if (!(span.weight > 0.0f)) return;
        // Spans compete as they come; the number that decided is spread over [0,1) again.
        sum += span.weight;
        const float p = span.weight / sum;
        if (u < p) {
            chosen = span;
            u /= p;
        } else {
            u = (u - p) / (1.0f - p);
        }
    });
    if (!(chosen.weight > 0.0f)) return std::nullopt;
    LineSample sample;
    sample.t = chosen.distance(u);
    sample.pdf = emissive_line_pdf(volume, bricks, ray, sample.t);
    if (!(sample.pdf > 0.0f)) return std::nullopt;
    return sample;
}

float emissive_line_pdf(const Volume& volume, const EmissiveBricks& bricks, const Ray& ray, float t)
{
    float sum = 0.0f;
    float here = 0.0f;
    for_each_emissive_span(volume, bricks, ray, [&](const EmissiveSpan& span) {
        sum += span.weight;
        here += span.weight * span.pdf(t);
    });
    return here > 0.0f ? here / sum : 0.0f;
}

}  // namespace mote
