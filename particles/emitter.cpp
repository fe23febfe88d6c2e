#include "particles/emitter.h"

#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/parallel.h"
#include "particles/emitter_kinds.h"

namespace mote {

namespace {

constexpr float room_temperature = 300.0f;  ///< [K]

void require(bool is_good, const char* what)
{
    if (!is_good) throw Error(ExitCode::Input, fmt::format("emitter: {}", what));
}

bool is_positive(float x)
{
    return x > 0.0f && std::isfinite(x);
}

bool is_not_negative(float x)
{
    return x >= 0.0f && std::isfinite(x);
}

void check(const EmitterParams& params)
{
    require(params.count >= 1 && params.count <= 100'000'000, "count must be in [1, 100000000]");
    require(is_finite(params.position), "position must be finite");
    require(is_positive(params.size), "size must be above 0");
    require(is_not_negative(params.speed), "speed must not be negative");
    require(is_positive(params.lifetime), "lifetime must be above 0");
    require(is_not_negative(params.turbulence), "turbulence must not be negative");
    require(is_positive(params.turbulence_size), "turbulence_size must be above 0");
    require(is_not_negative(params.drag), "drag must not be negative");
    require(std::isfinite(params.gravity), "gravity must be finite");
    require(params.spread >= 0.0f && params.spread <= 80.0f, "spread must be in [0, 80] degrees");
    require(is_positive(params.radius), "radius must be above 0");
    require(is_not_negative(params.radius_growth), "radius_growth must not be negative");
    require(is_not_negative(params.mass), "mass must not be negative");
    require(is_not_negative(params.temperature), "temperature must not be negative");
    require(is_not_negative(params.cooling), "cooling must not be negative");
    require(std::isfinite(params.start_time), "start_time must be finite");
}

EmissionPlan make_emission(const EmitterParams& params, double since_start)
{
    switch (params.kind) {
        case EmitterKind::Plume:
            return emit_plume(params, since_start);
        case EmitterKind::Burst:
            return emit_burst(params, since_start);
        case EmitterKind::Disk:
            return emit_disk(params, since_start);
        case EmitterKind::Snow:
            return emit_snow(params, since_start);
    }
    throw Error(ExitCode::Input, "emitter: unknown kind");
}

/// Mass share at this part of life; its mean over life is 1 - (fade_in + fade_out) / 2.
float fade(const EmissionPlan& emission, float life)
{
    const float in = emission.fade_in > 0.0f ? smooth_step(life / emission.fade_in) : 1.0f;
    const float out =
        emission.fade_out > 0.0f ? smooth_step((1.0f - life) / emission.fade_out) : 1.0f;
    return in * out;
}

void allocate(ParticleSet& set, size_t count, const AttributeMask& mask)
{
    set.position.resize(count);
    set.radius.resize(count);
    set.mass.resize(count);
    if (mask.velocity) set.velocity.resize(count);
    if (mask.temperature) set.temperature.resize(count);
    if (mask.color) set.color.resize(count);
    if (mask.id) set.id.resize(count);
    if (mask.age) set.age.resize(count);
}

void store(const EmitterParams& params, const EmissionPlan& emission, const ParticleBlock& block,
           size_t lanes, float particle_mass, ParticleSet& set, size_t first)
{
    for (size_t i = 0; i < lanes; ++i) {
        const size_t to = first + i;
        set.position[to] = params.position + Vec3(block.p.x[i], block.p.y[i], block.p.z[i]);
        set.radius[to] = params.radius + params.radius_growth * block.age[i];
        set.mass[to] = particle_mass * fade(emission, block.life[i]);
    }
    for (size_t i = 0; i < lanes && !set.velocity.empty(); ++i) {
        set.velocity[first + i] = Vec3(block.v.x[i], block.v.y[i], block.v.z[i]);
    }
    for (size_t i = 0; i < lanes && !set.temperature.empty(); ++i) {
        const float kept = params.cooling > 0.0f ? std::exp(-params.cooling * block.age[i]) : 1.0f;
        set.temperature[first + i] =
            room_temperature + (params.temperature - room_temperature) * kept;
    }
    for (size_t i = 0; i < lanes && !set.color.empty(); ++i) set.color[first + i] = params.color;
    for (size_t i = 0; i < lanes && !set.id.empty(); ++i) set.id[first + i] = block.id[i];
    for (size_t i = 0; i < lanes && !set.age.empty(); ++i) set.age[first + i] = block.age[i];
}

}  // namespace

Population steady_population(const EmitterParams& params, double since_start, bool is_full_at_start)
{
    Population population;
    population.rate = static_cast<double>(params.count) / double{params.lifetime};
    population.clock = since_start + (is_full_at_start ? double{params.lifetime} : 0.0);
    const auto last = static_cast<int64_t>(population.clock * population.rate);
    population.first_id = std::max<int64_t>(0, last - params.count + 1);
    population.count = last - population.first_id + 1;
    return population;
}

void set_ages(const Population& population, float lifetime, size_t first, ParticleBlock& block)
{
    for (size_t i = 0; i < lane_count; ++i) {
        const auto offset = std::min(static_cast<int64_t>(first + i), population.count - 1);
        block.id[i] = population.first_id + offset;
        block.age[i] = population.age(block.id[i]);
        block.life[i] = block.age[i] / lifetime;
    }
}

ParticleSet emit_particles(const EmitterParams& params, double time_s, const AttributeMask& mask)
{
    check(params);
    ParticleSet set;
    const double since_start = time_s - double{params.start_time};
    if (!(since_start >= 0.0)) return set;
    const EmissionPlan emission = make_emission(params, since_start);
    const auto count = static_cast<size_t>(emission.count);
    allocate(set, count, mask);
    const float mean_fade =
        emission.is_steady ? 1.0f - 0.5f * (emission.fade_in + emission.fade_out) : 1.0f;
    const float particle_mass = params.mass / (mean_fade * static_cast<float>(params.count));
    parallel_for(count, 256 * lane_count, [&](size_t begin, size_t end) {
        ParticleBlock block;
        for (size_t first = begin; first < end; first += lane_count) {
            emission.fill(block, first);
            const size_t lanes = std::min(lane_count, end - first);
            store(params, emission, block, lanes, particle_mass, set, first);
        }
    });
    return set;
}

}  // namespace mote
