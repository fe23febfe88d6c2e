#include "march/shadow_grid.h"

#include "core/parallel.h"
#include "volumes/media_extent.h"

namespace mote {
namespace {

Vec3i nodes_for(Vec3 extent, float spacing)
{
    return glm::max(Vec3i(glm::ceil(extent / spacing)) + 1, Vec3i(2));
}

double node_count(Vec3i count)
{
    return double(count.x) * double(count.y) * double(count.z);
}

}  // namespace

ShadowGrid::ShadowGrid(const Media& media, const std::vector<MarchLight>& lights,
                       const MarchParams& params)
    : light_count_(lights.size())
{
    Bounds3 bounds;
    for (const Volume& volume : media.volumes) {
        if (!is_void(volume)) bounds.extend(world_bounds(volume));
    }
    if (bounds.is_empty() || lights.empty()) bounds = {Vec3(0.0f), Vec3(0.0f)};
    const Vec3 extent = bounds.extent();
    lo_ = bounds.lo;
    spacing_ = std::max(params.shadow_spacing * finest_voxel(media),
                        1e-4f * max_component(Spectrum(extent)));
    if (!(spacing_ > 0.0f)) spacing_ = 1.0f;
    const double budget =
        std::max(8.0, double(params.node_budget) / std::max(1.0, double(light_count_)));
    while (node_count(nodes_for(extent, spacing_)) > budget && spacing_ < max_component(extent)) {
        spacing_ *= 1.05f;
    }
    count_ = nodes_for(extent, spacing_);
    values_.assign(static_cast<size_t>(node_count(count_)) * light_count_, 1.0f);
    const auto rows = static_cast<size_t>(count_.y) * static_cast<size_t>(count_.z);
    parallel_for(rows, 1, [&](size_t begin, size_t end) {
        for (size_t node = begin * static_cast<size_t>(count_.x);
             node < end * static_cast<size_t>(count_.x); ++node) {
            const auto nx = static_cast<size_t>(count_.x);
            const auto ny = static_cast<size_t>(count_.y);
            const size_t line = node / nx;
            const size_t slice = line / ny;
            const Vec3 x =
                lo_ + spacing_ * Vec3(static_cast<float>(node % nx), static_cast<float>(line % ny),
                                      static_cast<float>(slice));
            for (size_t i = 0; i < light_count_; ++i) {
                const MarchArrival a = arrival(lights[i], x);
                const Ray ray{x, a.wi, cache_time};
                values_[node * light_count_ + i] =
                    std::exp(-optical_depth(media, ray, {0.0f, a.distance}));
            }
        }
    });
}

ShadowGrid::Place ShadowGrid::place(Vec3 x) const
{
    const Vec3 last = Vec3(count_ - 1);
    const Vec3 p = glm::clamp((x - lo_) / spacing_, Vec3(0.0f), last);
    const Vec3i c = glm::min(Vec3i(p), count_ - 2);
    const Vec3 f = p - Vec3(c);
    Place place{};
    for (int i = 0; i < 8; ++i) {
        const Vec3i n = c + Vec3i(i & 1, i >> 1 & 1, i >> 2);
        place.node[i] =
            (static_cast<size_t>(n.z) * static_cast<size_t>(count_.y) + static_cast<size_t>(n.y)) *
                static_cast<size_t>(count_.x) +
            static_cast<size_t>(n.x);
        place.weight[i] = ((i & 1) != 0 ? f.x : 1.0f - f.x) * ((i & 2) != 0 ? f.y : 1.0f - f.y) *
                          ((i & 4) != 0 ? f.z : 1.0f - f.z);
    }
    return place;
}

}  // namespace mote
