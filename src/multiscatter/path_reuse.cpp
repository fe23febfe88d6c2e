#include "multiscatter/path_reuse.h"

#include <cmath>

#include "restir/neighbours.h"

namespace mote {
namespace {

/// Share of histories whose suffix is traced again to see whether it may be kept, and by which
/// factor both may differ.
constexpr float checked_share = 0.25f;
constexpr float agreeing_factor = 1.5f;

/// Whether what a path found is found still, as far as that has been looked at.
bool is_still_valid(const PathWorld& world, const ReusedPath& y, Rng& rng)
{
    if (y.form == PathForm::Replay || rng.uniform() >= checked_share) return true;
    ReusedPath again = y;
    float ignored = 0.0f;
    find_light(world, again, ignored);
    const float now = luminance(again.E);
    const float then = luminance(y.E);
    return now <= agreeing_factor * then && then <= agreeing_factor * now;
}

/// The pixel's history, if it has one; its domain goes to `earlier`.
std::optional<OtherPath> history_of(const PathsView& pass, const PathHistory& before, int x, int y,
                                    const PixelDomain& own, PixelDomain& earlier, Rng& rng)
{
    const RestirParams& params = pass.world.frame.params;
    const bool still = !before.change.any();
    const FrameDomain& then = before.world.frame;
    const std::optional<PreviousPixel> from =
        still ? PreviousPixel{x, y, Vec3(0.0f)} : previous_pixel(then, pass.world.frame, own, true);
    if (!from) return std::nullopt;
    before.paths.domains.load(from->x, from->y, earlier);
    PathMap map{params.shift, make_ray_map(earlier.ray, own.ray, from->motion), from->motion};
    if (!map.ray.is_usable()) return std::nullopt;
    const PathReservoir& history = before.paths.reservoirs.at(from->x, from->y);
    float confidence = std::min(history.M, cap_of(params.temporal, still));
    if (!still) {
        confidence *= profile_agreement(own.bins, earlier.bins, map.ray.inverse(),
                                        params.temporal.validation);
    }
    if (!(confidence > 0.0f)) return std::nullopt;
    const Change& change = before.change;
    if (change.media || change.lights || change.surfaces || from->motion != Vec3(0.0f)) {
        map.suffix = params.indirect_suffix == IndirectSuffix::Traced ? SuffixRule::Traced
                                                                      : SuffixRule::Kept;
        if (map.suffix == SuffixRule::Kept && history.W > 0.0f &&
            !is_still_valid(pass.world, history.y, rng)) {
            return std::nullopt;
        }
    }
    OtherPath other = make_other_path(pass.pixels.at(x, y).r, {pass.world, own}, history,
                                      {before.world, earlier}, confidence, map);
    other.age += 1.0f;
    return other;
}

MisForm temporal_form(const RestirParams& params, bool still)
{
    const MisForm form = temporal_rules(params, still).mis;
    return form == MisForm::Contribution ? MisForm::Pairwise : form;
}

/// Calls f(x, y, own domain, numbers) for the pixels of a tile that see media; what pixels have of
/// their own is `out` until f says otherwise.
template <class F>
void for_each_pixel_of_media(const PathsView& pass, const Tile& tile, const PixelRng& rng,
                             const PathOutput& out, F&& f)
{
    PixelDomain own;
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
            out.pixels.at(x, y) = pass.pixels.at(x, y);
            if (!(pass.domains.depth(x, y) > 0.0f)) continue;
            pass.domains.load(x, y, own);
            Rng numbers = rng(x, y);
            f(x, y, own, numbers);
        }
    }
}

}  // namespace

void reuse_paths_in_time(const PathsView& pass, const PathHistory& before, const Tile& tile,
                         const PixelRng& rng, const PathOutput& out, ReuseCounts& counts)
{
    const MisForm form = temporal_form(pass.world.frame.params, !before.change.any());
    PixelDomain earlier;
    for_each_pixel_of_media(
        pass, tile, rng, out, [&](int x, int y, const PixelDomain& own, Rng& numbers) {
            const std::optional<OtherPath> other =
                history_of(pass, before, x, y, own, earlier, numbers);
            if (!other) return;
            ++counts.histories;
            out.pixels.at(x, y) = combine_paths(pass.pixels.at(x, y), {&*other, 1}, form, numbers,
                                                out.light.at(x, y));
        });
}

void reuse_paths_in_space(const PathsView& pass, const Tile& tile, const PixelRng& rng,
                          const PathOutput& out, ReuseCounts& counts)
{
    MOTE_ASSERT(&out.pixels != &pass.pixels);
    const RestirParams& params = pass.world.frame.params;
    const MisForm form = spatial_rules(params).mis;
    std::vector<OtherPath> others;
    PixelDomain other;
    for_each_pixel_of_media(
        pass, tile, rng, out, [&](int x, int y, const PixelDomain& own, Rng& numbers) {
            const PathPixel& mine = pass.pixels.at(x, y);
            const float turn = 2.0f * pi * numbers.uniform();
            others.clear();
            const auto add = [&](int nx, int ny) {
                if (!(pass.domains.depth(nx, ny) > 0.0f)) return;
                pass.domains.load(nx, ny, other);
                const PathReservoir& reservoir = pass.pixels.at(nx, ny).r;
                const PathMap map{params.shift, make_ray_map(other.ray, own.ray, Vec3(0.0f))};
                others.push_back(make_other_path(mine.r, {pass.world, own}, reservoir,
                                                 {pass.world, other}, reservoir.M, map));
            };
            for_each_neighbour(x, y, pass.domains.width(), pass.domains.height(),
                               params.spatial.neighbours, params.spatial.radius_px, turn, add);
            counts.neighbours += static_cast<int64_t>(others.size());
            if (others.empty()) return;
            out.pixels.at(x, y) = combine_paths(mine, others, form, numbers, out.light.at(x, y));
        });
}

}  // namespace mote
