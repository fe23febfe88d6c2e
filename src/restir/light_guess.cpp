#include "restir/light_guess.h"

#include <algorithm>
#include <cmath>

#include "core/rng.h"
#include "core/sampling.h"
#include "restir/coarse_media.h"
#include "volumes/depth_batch.h"
#include "volumes/media_extent.h"

namespace mote {
namespace {

constexpr uint32_t ray_count = 512;
/// Deeper ones count for nothing, in either media.
constexpr float deepest = 8.0f;
/// Bounds the noise of guesses that are wrong altogether.
constexpr float least_chance = 1.0f / 32.0f;
/// Slope over the ratio of the errors, by measurement (bench_plume_g3, 128^3 to 512^3): about the
/// root of what a coarse ray costs over an exact one, but rays of one pixel are well spread, so
/// together they err less by the directions than alone.
constexpr float slope_per_ratio = 1.8f;
/// Slopes up to which coarse media pay, and up to which coarser ones still do.
constexpr float largest_slope = 2.5f;
constexpr float largest_coarser_slope = 1.9f;

/// Rays in all directions from around the nodes.
std::vector<DepthQuery> rays_from(const SmokeLattice& lattice)
{
    std::vector<DepthQuery> rays;
    const auto nodes = static_cast<uint32_t>(lattice.active_count());
    for (uint32_t i = 0; i < ray_count && nodes > 0; ++i) {
        Rng rng(0, 0, Stream::LightGuess, i, 0);
        const auto slot = 1 + static_cast<uint32_t>(rng.uniform() * static_cast<float>(nodes));
        const Vec3 x = lattice.position(lattice.nodes[slot]);
        const Vec3 offset = lattice.spacing * (rng.uniform3() - 0.5f);
        rays.push_back({x + offset, infinity, sample_sphere(rng.uniform2()), cache_time, infinity});
    }
    return rays;
}

struct Walked {
    std::vector<DepthQuery> rays;
    std::vector<float> tau;  ///< exact
    float directions_error;  ///< root mean square, of transmittances
};

std::vector<float> depths_of(const Media& media, std::span<const DepthQuery> rays)
{
    std::vector<float> tau(rays.size());
    WalkCounts counts;
    optical_depths(media, rays, tau, counts);
    return tau;
}

std::vector<float> marched_depths_of(const Media& media, std::span<const DepthQuery> rays)
{
    std::vector<float> tau(rays.size());
    WalkCounts counts;
    march_depths(media, rays, tau, counts);
    return tau;
}

Walked walk(const Media& media, const DirectionTransmittance& directions)
{
    Walked out{rays_from(directions.lattice()), {}, 0.0f};
    out.tau = depths_of(media, out.rays);
    double sum = 0.0;
    for (size_t i = 0; i < out.rays.size(); ++i) {
        const DepthQuery& ray = out.rays[i];
        const auto error =
            static_cast<double>(directions.transmittance(ray.o, ray.d) - std::exp(-out.tau[i]));
        sum += error * error;
    }
    if (!out.rays.empty()) sum /= static_cast<double>(out.rays.size());
    out.directions_error = static_cast<float>(std::sqrt(sum));
    return out;
}

/// Slope for coarse media: depths err by about the root of the depth, times a factor. Not finite
/// where nothing errs.
float slope_for(const Media& coarse, const Walked& exact)
{
    const std::vector<float> guessed = marched_depths_of(coarse, exact.rays);
    double squares = 0.0;
    double sum = 0.0;
    for (size_t i = 0; i < guessed.size(); ++i) {
        if (guessed[i] > deepest) continue;
        const auto error = static_cast<double>(guessed[i] - exact.tau[i]);
        squares += error * error;
        sum += static_cast<double>(guessed[i]);
    }
    return slope_per_ratio * static_cast<float>(std::sqrt(squares / sum)) / exact.directions_error;
}

/// Whether any grid is not shared.
bool is_coarser(const Media& coarse, const Media& media)
{
    return std::any_of(coarse.volumes.begin(), coarse.volumes.end(), [&](const Volume& volume) {
        return std::none_of(media.volumes.begin(), media.volumes.end(),
                            [&](const Volume& fine) { return fine.density == volume.density; });
    });
}

}  // namespace

float correction_chance(float slope, float tau)
{
    return std::clamp(slope * std::sqrt(tau) * std::exp(-tau), least_chance, 1.0f);
}

LightGuess make_light_guess(const Media& media, const DirectionTransmittance& directions)
{
    LightGuess best;
    if (!is_coarser(directions.walked_media(), media)) return best;
    const Walked exact = walk(media, directions);
    float slope = slope_for(directions.walked_media(), exact);
    if (!(slope > 0.0f && slope < largest_slope)) return best;
    best = {directions.walked_media(), slope};
    Media coarser = coarse_media(best.media, 2.0f * directions.walked_voxel());
    if (!is_coarser(coarser, best.media)) return best;
    slope = slope_for(coarser, exact);
    if (slope > 0.0f && slope < largest_coarser_slope) best = {std::move(coarser), slope};
    return best;
}

}  // namespace mote
