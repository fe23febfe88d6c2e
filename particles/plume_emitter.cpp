#include <bit>
#include <cmath>

#include "core/sampling.h"
#include "particles/advect.h"
#include "particles/curl_noise.h"
#include "particles/emitter_kinds.h"

namespace mote {

namespace {

/// x^(-1/3) for x >= 1, to 1e-5: a guess from the exponent bits and two Newton steps.
inline float inverse_cube_root(float x)
{
    float y = std::bit_cast<float>(0x54a2fa8c - std::bit_cast<int32_t>(x) / 3);
    y *= (4.0f - x * y * y * y) * (1.0f / 3.0f);
    y *= (4.0f - x * y * y * y) * (1.0f / 3.0f);
    return y;
}

/// Mean flow of a plume above a round source: it widens at the half angle, its speed falls as
/// width^(-1/3) along the axis (Morton, Taylor and Turner 1956) and across it. Puffs leave the
/// source at a steady beat and roll up into rings that rise and grow with it: the billows.
struct PlumeFlow {
    float speed;
    float size;
    float tan_spread;
    float puff_rate;   ///< [1/s]
    float puff_phase;  ///< at the frame's time [turns]

    /// Adds the flow at points `p` and times `t` [s, relative to the frame] to `u`.
    void add(const Lanes3& p, const Lanes& t, Lanes3& u) const
    {
        const float inv_size = 1.0f / size;
        const float puff_turns = puff_rate / (0.6f * speed);
        for (size_t i = 0; i < lane_count; ++i) {
            const float height = p.y[i] > 0.0f ? p.y[i] : 0.0f;
            const float width = 1.0f + tan_spread * inv_size * height;  // in source radii
            const float inv_width = inv_size / width;
            const float slowing = inverse_cube_root(width);
            const float off_axis = (p.x[i] * p.x[i] + p.z[i] * p.z[i]) * inv_width * inv_width;
            const float ring = 1.0f / (1.0f + off_axis * off_axis);
            const float speed_here = speed * slowing;
            // Time since a puff at this height left the source: its speed falls, its spacing grows.
            const float travelled = puff_turns * height * 0.5f * (1.0f + 1.0f / slowing);
            const float turns = puff_rate * t[i] + puff_phase - travelled;
            const float grown = std::min(1.0f, height * inv_size);
            const float puff = puff_strength * grown * speed_here * ring;
            const float rise =
                speed_here / (1.0f + 0.6f * off_axis) + puff * (1.0f - off_axis) * sin_turns(turns);
            const float widen = (rise * tan_spread + puff * sin_turns(turns + 0.25f)) * inv_width;
            u.x[i] += widen * p.x[i];
            u.y[i] += rise;
            u.z[i] += widen * p.z[i];
        }
    }

    static constexpr float puff_strength = 0.35f;  ///< of the mean rise
};

void start_at_source(const EmitterParams& params, ParticleBlock& block)
{
    for (size_t i = 0; i < lane_count; ++i) {
        Rng rng = particle_rng(params, block.id[i], 0);
        const Vec2 disk = params.size * sample_disk(rng.uniform2());
        block.p.x[i] = disk.x;
        block.p.y[i] = 0.2f * params.size * (rng.uniform() - 0.5f);
        block.p.z[i] = disk.y;
    }
}

/// Strouhal number of puffing plumes is near 0.4: beats per (source diameter / speed).
PlumeFlow make_flow(const EmitterParams& params, double since_start)
{
    const float speed = std::max(params.speed, 1e-6f);
    const float puff_rate = 0.4f * speed / (2.0f * params.size);
    const double beats = double{puff_rate} * since_start;
    return {speed, params.size, std::tan(params.spread * pi / 180.0f), puff_rate,
            static_cast<float>(beats - std::floor(beats))};
}

}  // namespace

EmissionPlan emit_plume(const EmitterParams& params, double since_start)
{
    const Population population = steady_population(params, since_start, false);
    const PlumeFlow flow = make_flow(params, since_start);
    const AdvectSteps steps =
        choose_steps(params.lifetime, params.turbulence, params.turbulence_size, 32.0f);
    // Eddies are carried upwards with the smoke; a fixed pattern would look like a grate.
    const CurlNoise noise = make_curl_noise({params.turbulence_size, params.turbulence,
                                             Vec3(0.0f, 0.6f * params.speed, 0.0f), params.seed},
                                            since_start);
    // The jet leaves the source smooth and breaks up within the first large eddy.
    const float break_up = 1.5f * params.turbulence_size / params.speed;
    const auto fill = [=](ParticleBlock& block, size_t first) {
        set_ages(population, params.lifetime, first, block);
        start_at_source(params, block);
        const auto velocity_at = [&](int step, const Lanes3& p, Lanes3& u) {
            const float age = static_cast<float>(step) * steps.dt;
            Lanes t;
            for (size_t i = 0; i < lane_count; ++i) t[i] = age - block.age[i];
            eval_curl_noise(noise, p, t, u);
            const float strength = 0.15f + 0.85f * smooth_step(age / break_up);
            const float sink = params.drag > 0.0f
                                   ? -params.gravity * -std::expm1(-params.drag * age) / params.drag
                                   : -params.gravity * age;
            for (size_t i = 0; i < lane_count; ++i) {
                u.x[i] *= strength;
                u.y[i] = u.y[i] * strength + sink;
                u.z[i] *= strength;
            }
            flow.add(p, t, u);
        };
        advect(steps, block.age, velocity_at, block.p, block.v);
    };
    return {population.count, 0.05f, 0.35f, true, fill};
}

}  // namespace mote
