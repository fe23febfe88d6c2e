#pragma once

#include <cstdint>
#include <functional>

#include "core/rng.h"
#include "particles/lanes.h"
#include "particles/source.h"

/// What the emitter kinds share. To add one: an EmitterKind, a file with its emit_... function,
/// and its lines in emitter.cpp.
namespace mote {

/// Particles alive at one time. Births are evenly spaced, so that a full frame holds exactly
/// `EmitterParams::count` particles and ids rise with time.
struct Population {
    int64_t first_id = 0;
    int64_t count = 0;
    double clock = 0.0;  ///< seconds since the birth of particle 0
    double rate = 1.0;   ///< births per second

    [[nodiscard]] float age(int64_t id) const
    {
        return static_cast<float>(clock - static_cast<double>(id) / rate);
    }
};

/// Steady emission over `since_start` seconds; `is_full_at_start`: as if it had begun a lifetime
/// earlier.
[[nodiscard]] Population steady_population(const EmitterParams& params, double since_start,
                                           bool is_full_at_start);

/// One block of particles. The kind fills the rest; unused lanes repeat the last particle.
struct ParticleBlock {
    int64_t id[lane_count];
    Lanes age;   ///< [s]
    Lanes life;  ///< share of life that has passed, [0,1]: fades mass in and out
    Lanes3 p;    ///< position relative to params.position [m]
    Lanes3 v;    ///< velocity [m/s]
};

/// Sets ids, ages and shares of life of the block whose first particle has index `first`.
void set_ages(const Population& population, float lifetime, size_t first, ParticleBlock& block);

/// Fills the lanes of one block; `first` is the index of its first particle.
using EmitBlock = std::function<void(ParticleBlock& block, size_t first)>;

/// Random numbers of one particle: a pure function of (seed, id).
[[nodiscard]] inline Rng particle_rng(const EmitterParams& params, int64_t id, uint32_t purpose)
{
    const auto bits = static_cast<uint64_t>(id);
    return {params.seed, purpose, Stream::Emitter, static_cast<uint32_t>(bits),
            static_cast<uint32_t>(bits >> 32u)};
}

/// Smooth step from 0 to 1 over x in [0,1].
[[nodiscard]] inline float smooth_step(float x)
{
    const float u = std::clamp(x, 0.0f, 1.0f);
    return u * u * (3.0f - 2.0f * u);
}

/// Each kind: which particles there are, how mass fades, and what fills a block.
struct EmissionPlan {
    int64_t count = 0;
    float fade_in = 0.0f;   ///< share of life over which mass grows
    float fade_out = 0.0f;  ///< share of life over which it vanishes
    bool is_steady = true;  ///< ages are spread over life, so masses are scaled up for the fades
    EmitBlock fill;
};

[[nodiscard]] EmissionPlan emit_plume(const EmitterParams& params, double since_start);
[[nodiscard]] EmissionPlan emit_burst(const EmitterParams& params, double since_start);
[[nodiscard]] EmissionPlan emit_disk(const EmitterParams& params, double since_start);
[[nodiscard]] EmissionPlan emit_snow(const EmitterParams& params, double since_start);

}  // namespace mote
