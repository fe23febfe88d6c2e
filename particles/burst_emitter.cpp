#include <array>
#include <cmath>

#include "core/sampling.h"
#include "particles/advect.h"
#include "particles/curl_noise.h"
#include "particles/emitter_kinds.h"

namespace mote {

namespace {

/// Linear drag solved exactly: x(a) = x0 + v0 * reach + fall, dx/da = v0 * slow + fall_speed.
struct Drag {
    float slow = 1.0f;
    float reach = 0.0f;
    float fall = 0.0f;
    float fall_speed = 0.0f;
};

Drag solve_drag(double drag, double gravity, double age)
{
    const double x = drag * age;
    // (1 - e^-x) / x and (x - 1 + e^-x) / x^2, by series where they cancel.
    const double a = x > 1e-3 ? -std::expm1(-x) / x : 1.0 - x / 2.0 + x * x / 6.0;
    const double b = x > 1e-3 ? (x + std::expm1(-x)) / (x * x) : 0.5 - x / 6.0 + x * x / 24.0;
    return {static_cast<float>(std::exp(-x)), static_cast<float>(a * age),
            static_cast<float>(-gravity * b * age * age), static_cast<float>(-gravity * a * age)};
}

constexpr uint32_t puff_count = 64;

/// Launch velocities: half of the particles fill a ball, the others belong to puffs that shoot
/// out as swelling lumps of their own.
Vec3 launch_velocity(const EmitterParams& params, const std::array<Vec3, puff_count>& puffs,
                     Rng& rng)
{
    const Vec3 inside = std::cbrt(rng.uniform()) * sample_sphere(rng.uniform2());
    const float choice = rng.uniform();
    if (choice < 0.35f) return 0.6f * params.speed * inside;
    const auto puff =
        static_cast<size_t>((choice - 0.35f) / 0.65f * static_cast<float>(puff_count));
    return params.speed * (puffs[std::min<size_t>(puff, puff_count - 1)] + 0.2f * inside);
}

}  // namespace

EmissionPlan emit_burst(const EmitterParams& params, double since_start)
{
    if (since_start >= double{params.lifetime}) return {};
    const auto age = static_cast<float>(since_start);
    std::array<Vec3, puff_count> puffs;
    for (uint32_t i = 0; i < puff_count; ++i) {
        Rng rng = particle_rng(params, i, 1);
        const Vec3 direction = sample_sphere(rng.uniform2());
        puffs[i] = (0.45f + 0.35f * rng.uniform()) * direction;
    }
    const AdvectSteps steps =
        choose_steps(params.lifetime, params.turbulence, params.turbulence_size, 16.0f);
    std::vector<Drag> drag_at(static_cast<size_t>(steps.count));
    for (size_t i = 0; i < drag_at.size(); ++i) {
        drag_at[i] =
            solve_drag(params.drag, params.gravity, static_cast<double>(i) * double{steps.dt});
    }
    const Drag now = solve_drag(params.drag, params.gravity, since_start);
    const CurlNoise noise = make_curl_noise(
        {params.turbulence_size, params.turbulence, Vec3(0.0f), params.seed}, since_start);
    const auto fill = [=](ParticleBlock& block, size_t first) {
        Lanes3 v0;
        Lanes3 p0;
        for (size_t i = 0; i < lane_count; ++i) {
            block.id[i] = std::min(static_cast<int64_t>(first + i), params.count - 1);
            block.age[i] = age;
            block.life[i] = age / params.lifetime;
            Rng rng = particle_rng(params, block.id[i], 0);
            const Vec3 v = launch_velocity(params, puffs, rng);
            const Vec3 p = params.size * std::cbrt(rng.uniform()) * sample_sphere(rng.uniform2());
            v0.x[i] = v.x;
            v0.y[i] = v.y;
            v0.z[i] = v.z;
            p0.x[i] = p.x;
            p0.y[i] = p.y;
            p0.z[i] = p.z;
        }
        // Turbulence displaces particles from their exact ballistic paths.
        block.p = {};
        const auto velocity_at = [&](int step, const Lanes3& displacement, Lanes3& u) {
            const Drag& then = drag_at[static_cast<size_t>(step)];
            const float step_age = static_cast<float>(step) * steps.dt;
            Lanes3 p;
            Lanes t;
            for (size_t i = 0; i < lane_count; ++i) {
                p.x[i] = p0.x[i] + v0.x[i] * then.reach + displacement.x[i];
                p.y[i] = p0.y[i] + v0.y[i] * then.reach + then.fall + displacement.y[i];
                p.z[i] = p0.z[i] + v0.z[i] * then.reach + displacement.z[i];
                t[i] = step_age - age;
            }
            eval_curl_noise(noise, p, t, u);
        };
        if (params.turbulence > 0.0f)
            advect(steps, block.age, velocity_at, block.p, block.v);
        else
            block.v = {};
        for (size_t i = 0; i < lane_count; ++i) {
            block.p.x[i] += p0.x[i] + v0.x[i] * now.reach;
            block.p.y[i] += p0.y[i] + v0.y[i] * now.reach + now.fall;
            block.p.z[i] += p0.z[i] + v0.z[i] * now.reach;
            block.v.x[i] += v0.x[i] * now.slow;
            block.v.y[i] += v0.y[i] * now.slow + now.fall_speed;
            block.v.z[i] += v0.z[i] * now.slow;
        }
    };
    return {params.count, 0.02f, 0.4f, false, fill};
}

}  // namespace mote
