#include "volumes/ray_bins.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "volumes/bin_batch.h"
#include "volumes/bin_filler.h"
#include "volumes/collisions.h"

namespace mote {
namespace {

/// The part of a local ray between two distances, re-based to the first.
LocalRay part_of(const LocalRay& ray, float s0, float s1)
{
    LocalRay part = ray;
    part.o = ray.at(s0);
    part.s1 = s1 - s0;
    part.t0 = ray.t0 + static_cast<double>(s0);
    return part;
}

/// Bins of one medium.
void bin_one(const Volume& volume, const Ray& ray, float t_end, float cut, RayBins& bins,
             BinCounts& counts)
{
    const BrickGrid& grid = *volume.density;
    const LocalRay local = density_ray(volume, ray, {0.0f, t_end});
    if (local.misses()) return;
    BinFiller filler(volume, local, cut, bins);
    for_each_brick(grid, local, [&](const BrickSpan& span) {
        const BrickRange& range = grid.ranges[static_cast<size_t>(span.brick)];
        if (range.min == range.max) return filler.add_uniform(span.s0, span.s1, range.max);
        return for_each_cell(grid, local, span, [&](const CellSpan& cell) {
            return filler.add_cell(cell.s0, cell.s1, cell.integral());
        });
    });
    filler.finish(counts);
}

/// Depth of one medium between two distances of a table's ray.
float depth_between(const Volume& volume, const LocalRay& local, float s0, float s1)
{
    const LocalRay part = part_of(local, std::max(s0, 0.0f), std::min(s1, local.s1));
    if (part.misses()) return 0.0f;
    float sum = 0.0f;
    for_each_brick(*volume.density, part, [&](const BrickSpan& span) {
        sum += integrate_brick(*volume.density, part, span);
        return true;
    });
    return sum * volume.density_scale;
}

/// A stretch of a binned ray in the grids of all media that it meets, for any number of depths
/// along it. Distances count from bins.t0.
class MediaStretch {
  public:
    MediaStretch(const Media& media, const Ray& ray, const RayBins& bins, float s0, float s1)
    {
        parts_.reserve(media.volumes.size());
        for (const Volume& volume : media.volumes) {
            if (is_void(volume)) continue;
            const LocalRay local = density_ray(volume, ray, {bins.world_t(s0), bins.world_t(s1)});
            if (local.misses()) continue;
            parts_.push_back({&volume, local, static_cast<float>(local.t0 - bins.t0)});
        }
    }

    [[nodiscard]] float depth(float a, float b) const
    {
        float sum = 0.0f;
        for (const Part& part : parts_) {
            sum += depth_between(*part.volume, part.ray, a - part.start, b - part.start);
        }
        return sum;
    }

    [[nodiscard]] float sigma_t(float s) const
    {
        float sum = 0.0f;
        for (const Part& part : parts_) {
            const float own = s - part.start;
            if (!(own >= 0.0f && own <= part.ray.s1)) continue;
            sum +=
                part.volume->density_scale * sample_local(*part.volume->density, part.ray.at(own));
        }
        return sum;
    }

  private:
    struct Part {
        const Volume* volume;
        LocalRay ray;
        float start;  ///< where the ray's own distances begin
    };
    std::vector<Part> parts_;
};

const Volume* single_volume(const Media& media)
{
    return media.volumes.size() == 1 ? &media.volumes.front() : nullptr;
}

/// A ray in the grid of the only medium, between two distances of its bins.
LocalRay single_ray(const Volume& volume, const Ray& ray, const RayBins& bins, float s0, float s1)
{
    const GridFrame& frame =
        volume.at_rest ? volume.at_rest->density : frames_at(volume, ray.time).density;
    LocalRay part;
    const double t = bins.t0 + static_cast<double>(s0);
    part.o = Vec3(frame.point(ray.o) + t * frame.vector(ray.d));
    part.d = Vec3(frame.vector(ray.d));
    part.s1 = s1 - s0;
    part.t0 = t;
    return part;
}

float invert_single(const Volume& volume, const LocalRay& part, float tau)
{
    const BrickGrid& grid = *volume.density;
    float left = tau;
    float found = part.s1;
    for_each_brick(grid, part, [&](const BrickSpan& span) {
        const BrickRange& range = grid.ranges[static_cast<size_t>(span.brick)];
        if (range.min == range.max) {
            const float here = volume.density_scale * range.max * (span.s1 - span.s0);
            if (left >= here) {
                left -= here;
                return true;
            }
            found = span.s0 + left / (volume.density_scale * range.max);
            return false;
        }
        const float s = invert_brick(grid, part, span, volume.density_scale, left);
        if (s < 0.0f) return true;
        found = s;
        return false;
    });
    return std::clamp(found, 0.0f, part.s1);
}

/// Merges the bins of several media: the union of their edges, thinned to what fits, and the depth
/// of all media at each.
void bin_all(const Media& media, const Ray& ray, float t_end, float cut, RayBins& bins,
             BinCounts& counts)
{
    std::vector<double> edges;  // world distances
    for (const Volume& volume : media.volumes) {
        if (is_void(volume)) continue;
        RayBins own;
        own.count = 0;
        own.cells = 0;
        bin_one(volume, ray, t_end, cut, own, counts);
        bins.cells += own.cells;
        for (int k = 0; k <= own.count && own.count > 0; ++k) {
            edges.push_back(own.t0 + static_cast<double>(own.s[k]));
        }
    }
    bins.count = 0;
    if (edges.size() < 2) return;
    std::sort(edges.begin(), edges.end());
    bins.t0 = edges.front();
    const size_t last = edges.size() - 1;
    const size_t keep = std::min<size_t>(last, RayBins::capacity);
    bins.s[0] = 0.0f;
    bins.tau[0] = 0.0f;
    const MediaStretch stretch(media, ray, bins, 0.0f, static_cast<float>(edges.back() - bins.t0));
    for (size_t i = 1; i <= keep; ++i) {
        const auto s = static_cast<float>(edges[i * last / keep] - bins.t0);
        const float before = bins.s[bins.count];
        if (!(s > before)) continue;
        const float depth = stretch.depth(before, s);
        ++bins.count;
        bins.s[bins.count] = s;
        bins.tau[bins.count] = bins.tau[bins.count - 1] + depth;
    }
}

/// Root of a monotone function by Newton's method, kept inside a bracket. Each step integrates only
/// what lies between it and the one before.
float invert_all(const MediaStretch& stretch, float s0, float s1, float whole, float tau)
{
    float lo = s0;
    float hi = s1;
    float s = s0 + (s1 - s0) * (tau / whole);
    float depth = stretch.depth(s0, s);
    for (int i = 0; i < 40; ++i) {
        const float excess = depth - tau;
        if (std::abs(excess) <= 2e-6f * whole) break;
        (excess > 0.0f ? hi : lo) = s;
        const float newton = s - excess / stretch.sigma_t(s);
        const float next = newton > lo && newton < hi ? newton : 0.5f * (lo + hi);
        if (next == s) break;
        depth += next > s ? stretch.depth(s, next) : -stretch.depth(next, s);
        s = next;
    }
    return s;
}

}  // namespace

void make_ray_bins(const Media& media, const Ray& ray, float cut, RayBins& bins, BinCounts& counts,
                   float t_end)
{
    bins.count = 0;
    bins.cells = 0;
    const int64_t met = counts.rays;
    if (const Volume* volume = single_volume(media)) {
        if (!is_void(*volume)) bin_one(*volume, ray, t_end, cut, bins, counts);
    } else {
        bin_all(media, ray, t_end, cut, bins, counts);
    }
    counts.misses += counts.rays == met ? 1 : 0;
}

void make_ray_bins(const Media& media, std::span<const BinQuery> queries, float cut,
                   BinCounts& counts)
{
    const Volume* volume = single_volume(media);
    if (volume && !is_void(*volume)) {
        bin_batch(*volume, queries, cut, counts);
        return;
    }
    for (const BinQuery& query : queries) {
        make_ray_bins(media, *query.ray, cut, *query.bins, counts, query.t_end);
    }
}

float invert_bin(const Media& media, const Ray& ray, const RayBins& bins, int k, float tau)
{
    const float s0 = bins.s[k];
    const float s1 = bins.s[k + 1];
    const float whole = bins.depth_of_bin(k);
    if (!(tau > 0.0f)) return s0;
    if (!(tau < whole)) return s1;
    if (const Volume* volume = single_volume(media)) {
        return s0 + invert_single(*volume, single_ray(*volume, ray, bins, s0, s1), tau);
    }
    const MediaStretch stretch(media, ray, bins, s0, s1);
    return std::clamp(invert_all(stretch, s0, s1, whole, tau), s0, s1);
}

float distance_at(const Media& media, const Ray& ray, const RayBins& bins, float tau)
{
    const float* first = bins.tau;
    const auto above = std::upper_bound(first + 1, first + bins.count, tau) - first;
    const int k = static_cast<int>(above) - 1;
    return invert_bin(media, ray, bins, k, tau - bins.tau[k]);
}

int bin_of(const RayBins& bins, float s)
{
    const float* first = bins.s;
    const auto above = std::upper_bound(first, first + bins.count + 1, s) - first;
    return std::clamp(static_cast<int>(above) - 1, 0, std::max(bins.count - 1, 0));
}

float depth_to(const Media& media, const Ray& ray, const RayBins& bins, float s)
{
    if (bins.empty() || !(s > bins.s[0])) return 0.0f;
    if (!(s < bins.s[bins.count])) return bins.depth();
    const int k = bin_of(bins, s);
    const float near = bins.s[k];
    const float within =
        single_volume(media)
            ? depth_between(media.volumes.front(),
                            single_ray(media.volumes.front(), ray, bins, near, s), 0.0f, s - near)
            : MediaStretch(media, ray, bins, near, s).depth(near, s);
    return std::min(bins.tau[k] + within, bins.tau[k + 1]);
}

}  // namespace mote
