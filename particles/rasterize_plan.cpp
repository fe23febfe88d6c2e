#include "particles/rasterize_plan.h"

#include <fmt/core.h>

#include "core/error.h"
#include "core/parallel.h"

namespace mote {
namespace {

constexpr size_t block_size = 32'768;           ///< particles
constexpr double splats_per_chunk = 300'000.0;  ///< about 7 MB
/// Index coordinates stay this far inside the 32-bit range.
constexpr double largest_index = 2147483647.0 - 1024.0;

/// What one block of particles asks for.
struct BlockReport {
    double splats = 0.0;  ///< expected copies over tiles
    size_t unusable = 0;
    size_t invalid = 0;     ///< of these, the ones that have a mass
    size_t bad = SIZE_MAX;  ///< first particle that cannot be rasterised
};

bool is_in_range(const ParticleSet& particles, const SplatRules& rules, size_t i)
{
    Vec3d reach = glm::abs(Vec3d(particles.position[i]));
    if (rules.blurs() && !particles.velocity.empty()) {
        const double t = std::max(std::abs(rules.open_s), std::abs(rules.close_s));
        reach += glm::abs(Vec3d(particles.velocity[i])) * t;
    }
    const double farthest = std::max(reach.x, std::max(reach.y, reach.z));
    return farthest * rules.index_from_world <= largest_index;
}

double expected_tiles(float support)
{
    const double along_axis = 2.0 * static_cast<double>(support) / tile_size + 1.0;
    return along_axis * along_axis * along_axis;
}

/// Whether a block of resting particles without channels, by far the most common kind, is plainly
/// fine; one pass of vector comparisons. False means: look at each particle.
bool is_plainly_usable(const ParticleSet& particles, const SplatRules& rules, size_t first,
                       size_t last)
{
    const bool is_simple = !rules.use_velocity && !rules.use_temperature && !rules.use_color &&
                           !particles.mass.empty() && !particles.radius.empty();
    if (!is_simple) return false;
    const float far = static_cast<float>(1e9 / rules.index_from_world);
    const float wide = static_cast<float>(tile_size / rules.index_from_world);
    const float heavy = static_cast<float>(1e12 / rules.inv_voxel_volume);
    int bad = 0;  // no branches, so that the loop vectorises; NaN compares false
    for (size_t i = first; i < last; ++i) {
        const Vec3 p = glm::abs(particles.position[i]);
        const float r = particles.radius[i];
        const float m = particles.mass[i];
        bad += p.x <= far ? 0 : 1;
        bad += p.y <= far ? 0 : 1;
        bad += p.z <= far ? 0 : 1;
        bad += r >= 0.0f ? 0 : 1;
        bad += r <= wide ? 0 : 1;
        bad += m > 0.0f ? 0 : 1;
        bad += m <= heavy ? 0 : 1;
    }
    return bad == 0;
}

BlockReport inspect(const ParticleSet& particles, const SplatRules& rules, size_t first,
                    size_t last)
{
    BlockReport report;
    if (is_plainly_usable(particles, rules, first, last)) {
        const auto begin = particles.radius.begin();
        const float widest = *std::max_element(begin + static_cast<ptrdiff_t>(first),
                                               begin + static_cast<ptrdiff_t>(last));
        const double support = static_cast<double>(widest) * rules.index_from_world;
        report.splats = static_cast<double>(last - first) *
                        expected_tiles(std::max(min_support_voxels, static_cast<float>(support)));
        return report;
    }
    for (size_t i = first; i < last; ++i) {
        if (!is_usable(particles, rules, i)) {
            ++report.unusable;
            report.invalid += mass_of(particles, rules, i) == 0.0f ? 0 : 1;
            continue;
        }
        const float support = support_of(particles, rules, i);
        if (!(support <= max_support_voxels) || !is_in_range(particles, rules, i)) {
            report.bad = i;
            break;
        }
        report.splats += expected_tiles(support) * stamp_count(particles, rules, i, support);
    }
    return report;
}

[[noreturn]] void throw_bad_particle(const ParticleSet& particles, const SplatRules& rules,
                                     const RasterizeParams& params, size_t i)
{
    const float support = support_of(particles, rules, i);
    if (!(support <= max_support_voxels)) {
        throw Error(
            ExitCode::Memory,
            fmt::format("particle {}: radius {:g} m is {:g} voxels of {:g} m, more than "
                        "{:g}; raise voxel_size or lower the radius",
                        i, particles.radius[i], support, params.voxel_size, max_support_voxels));
    }
    const Vec3 p = particles.position[i];
    throw Error(ExitCode::Input,
                fmt::format("particle {}: position ({:g}, {:g}, {:g}) m is outside the 32-bit "
                            "index range of voxels of {:g} m; raise voxel_size, or remove the "
                            "particle or its velocity",
                            i, p.x, p.y, p.z, params.voxel_size));
}

void require_length(const char* name, size_t length, size_t count)
{
    if (length == 0 || length == count) return;
    throw Error(ExitCode::Input, fmt::format("particles: {} values of {} for {} positions; give "
                                             "one per particle or none",
                                             length, name, count));
}

SplatRules make_rules(const ParticleSet& particles, const RasterizeParams& params)
{
    const double voxel = static_cast<double>(params.voxel_size);
    SplatRules rules{};
    rules.index_from_world = 1.0 / voxel;
    rules.inv_voxel_volume = 1.0 / (voxel * voxel * voxel);
    rules.open_s = static_cast<double>(params.shutter_open_s);
    rules.close_s = static_cast<double>(params.shutter_close_s);
    rules.missing_mass = 1.0f / static_cast<float>(std::max<size_t>(particles.size(), 1));
    rules.use_velocity = params.channels.velocity || rules.blurs();
    rules.use_temperature = params.channels.temperature && !particles.temperature.empty();
    rules.use_color = params.channels.color && !particles.color.empty();
    return rules;
}

void check(const ParticleSet& particles, const RasterizeParams& params)
{
    if (!(params.voxel_size > 0.0f) || !std::isfinite(params.voxel_size)) {
        throw Error(ExitCode::Input,
                    fmt::format("voxel_size is {:g} m; it must be positive", params.voxel_size));
    }
    if (!std::isfinite(params.shutter_open_s) || !std::isfinite(params.shutter_close_s)) {
        throw Error(ExitCode::Input, "the shutter's times must be finite");
    }
    const size_t count = particles.size();
    if (count > UINT32_MAX) {
        throw Error(ExitCode::Memory,
                    fmt::format("{} particles; at most {} can be rasterised", count, UINT32_MAX));
    }
    require_length("velocity", particles.velocity.size(), count);
    require_length("radius", particles.radius.size(), count);
    require_length("mass", particles.mass.size(), count);
    require_length("temperature", particles.temperature.size(), count);
    require_length("color", particles.color.size(), count);
}

}  // namespace

RasterPlan make_raster_plan(const ParticleSet& particles, const RasterizeParams& params)
{
    check(particles, params);
    RasterPlan plan;
    plan.rules = make_rules(particles, params);
    const size_t count = particles.size();
    std::vector<BlockReport> blocks((count + block_size - 1) / block_size);
    parallel_for(count, block_size, [&](size_t first, size_t last) {
        blocks[first / block_size] = inspect(particles, plan.rules, first, last);
    });

    const auto splats_per_wave = static_cast<double>(params.max_splats);
    double in_wave = 0.0;
    for (size_t b = 0; b < blocks.size(); ++b) {
        if (blocks[b].bad != SIZE_MAX) {
            throw_bad_particle(particles, plan.rules, params, blocks[b].bad);
        }
        plan.invalid += blocks[b].invalid;
        const size_t first = b * block_size;
        const size_t last = std::min(count, first + block_size);
        const double parts = std::clamp(std::ceil(blocks[b].splats / splats_per_chunk), 1.0,
                                        static_cast<double>(last - first));
        const size_t step =
            (last - first + static_cast<size_t>(parts) - 1) / static_cast<size_t>(parts);
        for (size_t i = first; i < last; i += step) {
            plan.chunks.push_back({i, std::min(last, i + step), blocks[b].unusable == 0});
            in_wave += blocks[b].splats / parts;
            if (in_wave < splats_per_wave) continue;
            plan.wave_end.push_back(plan.chunks.size());
            in_wave = 0.0;
        }
    }
    const bool is_open = plan.wave_end.empty() || plan.wave_end.back() != plan.chunks.size();
    if (is_open) plan.wave_end.push_back(plan.chunks.size());
    return plan;
}

}  // namespace mote
