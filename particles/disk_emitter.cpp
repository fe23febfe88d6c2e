#include <cmath>

#include "particles/curl_noise.h"
#include "particles/emitter_kinds.h"
#include "particles/wobble.h"

namespace mote {

namespace {

constexpr float arm_count = 2.0f;
constexpr float arm_contrast = 0.8f;   ///< below 1: neighbours never overtake each other
constexpr float arm_winding = 3.0f;    ///< 1 / tan(pitch angle), about 18 degrees
constexpr float pattern_speed = 0.4f;  ///< of the arms, in orbits of the rim
constexpr float core = 0.12f;          ///< radius inside which rotation is rigid, of the size
constexpr float thickness = 0.035f;    ///< of the size

/// Orbit of one particle, in closed form: circular, with the angle bunched towards two
/// logarithmic spiral arms (a density wave that turns on its own, so it never winds up).
void follow_orbit(const EmitterParams& params, double since_start, ParticleBlock& block, size_t i)
{
    Rng rng = particle_rng(params, block.id[i], 0);
    const float u = rng.uniform();
    const float share = 0.02f + 0.9f * u * (0.4f + 0.6f * u);  // densest in the middle
    const float r = params.size * share * (0.9f + 0.2f * rng.uniform());
    const float omega = params.speed / (r + core * params.size);
    const float mean_angle = 2.0f * pi * rng.uniform() + omega * block.age[i];
    const float pattern_omega = pattern_speed * params.speed / params.size;
    const auto turned =
        static_cast<float>(std::remainder(double{pattern_omega} * since_start, 2.0 * double{pi}));
    const float wave = arm_count * (mean_angle - turned + arm_winding * std::log(r / params.size));
    const float angle = mean_angle - arm_contrast / arm_count * std::sin(wave);
    const float angle_rate = omega - arm_contrast * std::cos(wave) * (omega - pattern_omega);
    block.p.x[i] = r * std::cos(angle);
    block.p.z[i] = r * std::sin(angle);
    block.v.x[i] = -block.p.z[i] * angle_rate;
    block.v.z[i] = block.p.x[i] * angle_rate;
    // Bobs through the plane; the triangular height distribution is densest in the middle.
    const float height = thickness * params.size * (rng.uniform() + rng.uniform());
    const float bob = 2.0f * pi * rng.uniform() + 1.5f * omega * block.age[i];
    block.p.y[i] = height * std::sin(bob);
    block.v.y[i] = 1.5f * omega * height * std::cos(bob);
}

}  // namespace

EmissionPlan emit_disk(const EmitterParams& params, double since_start)
{
    const Population population = steady_population(params, since_start, true);
    const CurlNoise noise = make_curl_noise(
        {params.turbulence_size, params.turbulence, Vec3(0.0f), params.seed}, since_start);
    const float wobble_time = choose_wobble_time(params);
    const auto fill = [=](ParticleBlock& block, size_t first) {
        set_ages(population, params.lifetime, first, block);
        for (size_t i = 0; i < lane_count; ++i) follow_orbit(params, since_start, block, i);
        if (wobble_time > 0.0f) add_wobble(noise, wobble_time, block);
    };
    return {population.count, 0.25f, 0.25f, true, fill};
}

}  // namespace mote
