#include "restir/surface_reuse.h"

#include "restir/neighbours.h"

namespace mote {
namespace {

constexpr float least_cosine = 0.906308f;  // of 25 degrees
constexpr float most_distance_change = 0.1f;
constexpr float most_roughness_change = 0.2f;
/// Confidence [passes] below which history counts as missing.
constexpr float short_history = 2.0f;

bool is_alike(const Material& a, const Material& b)
{
    return a.kind == b.kind && std::abs(a.roughness - b.roughness) <= most_roughness_change;
}

/// Where the object's point was in the frame before.
Vec3 earlier_position(const FrameDomain& before, const FrameDomain& now,
                      const SurfaceDomain& domain)
{
    const Surfaces& surfaces = *now.scene->surfaces;
    const auto object = static_cast<size_t>(domain.v.object);
    if (!before.scene->surfaces || before.scene->surfaces->objects.size() <= object) {
        return domain.v.p;
    }
    const InstanceFrame here = surfaces.bvh->frame_at(object, domain.time);
    const InstanceFrame there = before.scene->surfaces->bvh->frame_at(object, domain.time);
    return Vec3(there.point(here.inverse * (Vec3d(domain.v.p) - here.offset)));
}

CombineRules with_surface_rules(CombineRules rules, const RestirParams& params)
{
    const SurfaceVisibility visibility = params.surface.visibility;
    const bool is_exact = visibility == SurfaceVisibility::Exact;
    rules.visibility = is_exact ? TargetVisibility::Exact : TargetVisibility::None;
    rules.averages_V = visibility == SurfaceVisibility::Weighted;
    rules.shades_all = shades_all(params);
    rules.traces_V = visibility == SurfaceVisibility::None && rules.shades_all;
    return rules;
}

/// As finish_tile, with the choice ahead where weights depend on it.
void finish_surfaces(const Tile& tile, const PixelRng& rng, const Scene& there,
                     Combination& combination, const ReuseOutput& out, WalkCounts& walks)
{
    if (combination.chooses_first()) {
        for (int y = tile.y0; y < tile.y1; ++y) {
            for (int x = tile.x0; x < tile.x1; ++x) {
                Rng numbers = rng(x, y);
                combination.choose(numbers);
            }
        }
        combination.trace_chosen(there, walks);
    }
    finish_tile(tile, rng, combination, out);
}

}  // namespace

std::optional<PreviousSurface> previous_surface(const FrameDomain& before, const FrameDomain& now,
                                                const SurfaceDomain& domain)
{
    const Vec3 p = earlier_position(before, now, domain);
    const Camera& camera = before.scene->camera;
    const std::optional<Vec2> film = project(camera, p, domain.time);
    if (!film || !(film->x >= 0.0f) || !(film->y >= 0.0f)) return std::nullopt;
    const Vec3d eye = camera.world_from_camera.at(domain.time).translate;
    PreviousSurface out{static_cast<int>(film->x), static_cast<int>(film->y),
                        static_cast<float>(glm::length(Vec3d(p) - eye))};
    if (out.x >= camera.width || out.y >= camera.height) return std::nullopt;
    return out;
}

bool is_similar(const SurfaceDomain& own, const SurfaceDomain& other, float distance)
{
    if (!other.is_sampled() || !own.is_sampled()) return false;
    return glm::dot(own.v.ns, other.v.ns) >= least_cosine &&
           std::abs(other.distance - distance) <= most_distance_change * distance &&
           is_alike(own.v.material, other.v.material);
}

CombineRules surface_temporal_rules(const RestirParams& params, bool still)
{
    RestirParams own = params;
    own.mis = surface_mis(params);
    return with_surface_rules(temporal_rules(own, still), params);
}

CombineRules surface_spatial_rules(const RestirParams& params)
{
    RestirParams own = params;
    own.mis = surface_mis(params);
    if (own.mis == ReuseMis::Auto) own.mis = ReuseMis::Pairwise;
    CombineRules rules = with_surface_rules(temporal_rules(own, false), params);
    rules.traces_V |= params.surface.visibility == SurfaceVisibility::Weighted;
    return rules;
}

void reuse_surfaces_in_time(const SurfaceView& pass, const FinishedPass& before, bool still,
                            const Tile& tile, const PixelRng& rng, Combination& scratch,
                            const ReuseOutput& out, WalkCounts& walks, ReuseCounts& counts)
{
    const SurfaceRestirParams& params = pass.frame.params.surface;
    scratch.clear();
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
            scratch.begin_pixel(pass.reservoirs.at(x, y));
            const SurfaceDomain& own = pass.domains.at(x, y);
            if (!own.is_sampled()) continue;
            Acceptance& acceptance = out.acceptance.at(x, y);
            ++acceptance.asked;
            const std::optional<PreviousSurface> from =
                still ? PreviousSurface{x, y, own.distance}
                      : previous_surface(before.frame, pass.frame, own);
            if (!from) continue;
            const SurfaceDomain& earlier = before.surfaces.at(from->x, from->y);
            if (!is_similar(own, earlier, from->distance)) continue;
            const Reservoir& history = before.surface_reservoirs.at(from->x, from->y);
            const float confidence = std::min(history.M, params.cap);
            if (!(confidence > 0.0f)) continue;
            ++counts.histories;
            ++acceptance.used;
            Reservoir aged = history;
            aged.age += 1.0f;
            scratch.add_other({pass.frame, own}, {before.frame, earlier}, aged, confidence);
        }
    }
    scratch.trace(*pass.frame.scene, *before.frame.scene, walks);
    finish_surfaces(tile, rng, *before.frame.scene, scratch, out, walks);
}

void reuse_surfaces_in_space(const SurfaceView& pass, const Tile& tile, const PixelRng& rng,
                             Combination& scratch, const ReuseOutput& out, WalkCounts& walks,
                             ReuseCounts& counts)
{
    MOTE_ASSERT(&out.reservoirs != &pass.reservoirs);
    const SurfaceRestirParams& params = pass.frame.params.surface;
    const int width = pass.domains.width();
    const int height = pass.domains.height();
    scratch.clear();
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
            const PixelReservoir& mine = pass.reservoirs.at(x, y);
            scratch.begin_pixel(mine);
            const SurfaceDomain& own = pass.domains.at(x, y);
            if (!own.is_sampled()) continue;
            Rng numbers = rng(x, y);
            const float turn = 2.0f * pi * numbers.uniform();
            const int count = params.neighbours * (mine.r.M < short_history ? params.boost : 1);
            Acceptance& acceptance = out.acceptance.at(x, y);
            acceptance.asked = static_cast<uint16_t>(acceptance.asked + count);
            for_each_neighbour(
                x, y, width, height, count, params.radius_px, turn, [&](int nx, int ny) {
                    const SurfaceDomain& other = pass.domains.at(nx, ny);
                    if (!is_similar(own, other, own.distance)) return;
                    ++counts.neighbours;
                    ++acceptance.used;
                    const Reservoir& r = pass.reservoirs.at(nx, ny).r;
                    scratch.add_other({pass.frame, own}, {pass.frame, other}, r, r.M);
                });
        }
    }
    scratch.trace(*pass.frame.scene, *pass.frame.scene, walks);
    finish_surfaces(tile, after_turn(rng), *pass.frame.scene, scratch, out, walks);
}

}  // namespace mote
