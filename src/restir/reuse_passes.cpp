#include "restir/reuse_passes.h"

#include <cmath>

#include "restir/neighbours.h"

namespace mote {
namespace {

/// Confidence that history may have: long where nothing moves, short where targets change (caps of
/// 20 in motion made noise worse than no reuse, in both prototypes).
constexpr float still_cap = 16.0f;
constexpr float moving_cap = 1.0f;

}  // namespace

float cap_of(const TemporalParams& params, bool still)
{
    if (params.cap > 0.0f) return params.cap;
    return still ? still_cap : moving_cap;
}

PixelRng after_turn(const PixelRng& rng)
{
    return [&rng](int x, int y) {
        Rng numbers = rng(x, y);
        (void)numbers.uniform();
        return numbers;
    };
}

void finish_tile(const Tile& tile, const PixelRng& rng, const Combination& combination,
                 const ReuseOutput& out)
{
    int pixel = 0;
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
            Rng numbers = rng(x, y);
            out.reservoirs.at(x, y) = combination.finish(pixel++, numbers, out.colors.at(x, y));
        }
    }
}

CombineRules temporal_rules(const RestirParams& params, bool still)
{
    CombineRules rules{params.shift, MisForm::Pairwise, params.visibility};
    switch (params.mis) {
        case ReuseMis::Auto:
            // Measured: balance has half the noise at rest, the defensive form in motion.
            rules.mis = still ? MisForm::Balance : MisForm::Pairwise;
            break;
        case ReuseMis::Balance:
            rules.mis = MisForm::Balance;
            break;
        case ReuseMis::Pairwise:
            break;
        case ReuseMis::Constant:
            rules.mis = MisForm::Constant;
            break;
        case ReuseMis::Contribution:
            rules.mis = MisForm::Contribution;
            break;
    }
    return rules;
}

CombineRules spatial_rules(const RestirParams& params)
{
    return {params.shift, params.mis == ReuseMis::Constant ? MisForm::Constant : MisForm::Pairwise,
            params.visibility};
}

void reuse_in_time(const PassView& pass, const FinishedPass& before, bool still, const Tile& tile,
                   const PixelRng& rng, Combination& scratch, const ReuseOutput& out,
                   WalkCounts& walks, ReuseCounts& counts)
{
    const RestirParams& params = pass.frame.params;
    scratch.clear();
    PixelDomain own;
    PixelDomain earlier;
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
            scratch.begin_pixel(pass.reservoirs.at(x, y));
            pass.domains.load(x, y, own);
            if (!(own.Z() > 0.0f)) continue;
            Acceptance& acceptance = out.acceptance.at(x, y);
            ++acceptance.asked;
            const std::optional<PreviousPixel> from =
                still ? PreviousPixel{x, y, Vec3(0.0f)}
                      : previous_pixel(before.frame, pass.frame, own, true);
            if (!from) continue;
            before.domains.load(from->x, from->y, earlier);
            const RayMap map = make_ray_map(earlier.ray, own.ray, from->motion);
            if (!map.is_usable()) continue;
            const Reservoir& history = before.reservoirs.at(from->x, from->y);
            const float agreement = still ? 1.0f
                                          : profile_agreement(own.bins, earlier.bins, map.inverse(),
                                                              params.temporal.validation);
            const float confidence =
                agreement * std::min(history.M, cap_of(params.temporal, still));
            if (!(confidence > 0.0f)) continue;
            ++counts.histories;
            ++acceptance.used;
            Reservoir aged = history;
            aged.age += 1.0f;
            scratch.add_other({pass.frame, own}, {before.frame, earlier}, aged, confidence, map);
        }
    }
    scratch.trace(*pass.frame.scene, *before.frame.scene, walks);
    finish_tile(tile, rng, scratch, out);
}

void reuse_in_space(const PassView& pass, const Tile& tile, const PixelRng& rng,
                    Combination& scratch, const ReuseOutput& out, WalkCounts& walks,
                    ReuseCounts& counts)
{
    MOTE_ASSERT(&out.reservoirs != &pass.reservoirs);
    const SpatialParams& params = pass.frame.params.spatial;
    scratch.clear();
    PixelDomain own;
    PixelDomain other;
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
            scratch.begin_pixel(pass.reservoirs.at(x, y));
            pass.domains.load(x, y, own);
            if (!(own.Z() > 0.0f)) continue;
            Rng numbers = rng(x, y);
            const float turn = 2.0f * pi * numbers.uniform();
            Acceptance& acceptance = out.acceptance.at(x, y);
            acceptance.asked = static_cast<uint16_t>(acceptance.asked + params.neighbours);
            const auto combine = [&](int nx, int ny) {
                if (!(pass.domains.depth(nx, ny) > 0.0f)) return;
                ++counts.neighbours;
                ++acceptance.used;
                pass.domains.load(nx, ny, other);
                const Reservoir& reservoir = pass.reservoirs.at(nx, ny).r;
                scratch.add_other({pass.frame, own}, {pass.frame, other}, reservoir, reservoir.M,
                                  make_ray_map(other.ray, own.ray, Vec3(0.0f)));
            };
            for_each_neighbour(x, y, pass.domains.width(), pass.domains.height(), params.neighbours,
                               params.radius_px, turn, combine);
        }
    }
    scratch.trace(*pass.frame.scene, *pass.frame.scene, walks);
    finish_tile(tile, after_turn(rng), scratch, out);
}

void shade_chosen(const PassView& pass, const Tile& tile, Buffer2D<Spectrum>& colors,
                  WalkCounts& walks)
{
    LightRays rays;
    PixelDomain own;
    int pixel = 0;
    std::vector<Spectrum> tile_colors;
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x, ++pixel) {
            tile_colors.emplace_back(0.0f);
            const Reservoir& r = pass.reservoirs.at(x, y).r;
            if (!(r.W > 0.0f)) continue;
            pass.domains.load(x, y, own);
            const Candidate c = evaluate(pass.frame, own, r.y);
            rays.add(pixel, c.x, c.arrival.wi, c.arrival.distance, own.ray.time, r.W * c.f,
                     infinity);
        }
    }
    rays.trace(*pass.frame.scene, walks);
    for (size_t i = 0; i < rays.size(); ++i) {
        tile_colors[static_cast<size_t>(rays.owners[i])] = rays.value(i);
    }
    pixel = 0;
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
            colors.at(x, y) = tile_colors[static_cast<size_t>(pixel++)];
        }
    }
}

}  // namespace mote
