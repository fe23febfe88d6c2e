#include <cmath>

#include "particles/curl_noise.h"
#include "particles/emitter_kinds.h"
#include "particles/wobble.h"

namespace mote {

namespace {

/// Column `index` of the snowfall: a flake falls through the box, and the next one (a new id,
/// elsewhere in the box) follows at the top.
void fall(const EmitterParams& params, double since_start, int64_t index, ParticleBlock& block,
          size_t i)
{
    Rng column = particle_rng(params, index, 1);
    const float fall_speed = std::max(params.speed, 1e-6f) * (0.7f + 0.6f * column.uniform());
    const float edge = 2.0f * params.size;
    const double boxes = double{column.uniform()} + since_start * double{fall_speed} / double{edge};
    const double flakes = std::floor(boxes);
    block.id[i] = index + params.count * static_cast<int64_t>(flakes);
    block.life[i] = static_cast<float>(boxes - flakes);
    block.age[i] = block.life[i] * edge / fall_speed;

    Rng rng = particle_rng(params, block.id[i], 0);
    const float x = edge * (rng.uniform() - 0.5f);
    const float z = edge * (rng.uniform() - 0.5f);
    // Flakes flutter in ellipses, at up to half their fall speed.
    const float omega = 2.0f * pi * (0.3f + 0.7f * rng.uniform());
    const float angle = 2.0f * pi * rng.uniform() + omega * block.age[i];
    const float sway_x = 0.5f * params.speed / omega * rng.uniform();
    const float sway_z = 0.5f * params.speed / omega * rng.uniform();
    const float sine = std::sin(angle);
    const float cosine = std::cos(angle);
    block.p.x[i] = x + sway_x * cosine;
    block.p.y[i] = params.size - fall_speed * block.age[i];
    block.p.z[i] = z + sway_z * sine;
    block.v.x[i] = -omega * sway_x * sine;
    block.v.y[i] = -fall_speed;
    block.v.z[i] = omega * sway_z * cosine;
}

}  // namespace

EmissionPlan emit_snow(const EmitterParams& params, double since_start)
{
    const CurlNoise noise = make_curl_noise(
        {params.turbulence_size, params.turbulence, Vec3(0.0f), params.seed}, since_start);
    const float wobble_time = choose_wobble_time(params);
    const auto fill = [=](ParticleBlock& block, size_t first) {
        for (size_t i = 0; i < lane_count; ++i) {
            const auto index = std::min(static_cast<int64_t>(first + i), params.count - 1);
            fall(params, since_start, index, block, i);
        }
        if (wobble_time > 0.0f) add_wobble(noise, wobble_time, block);
    };
    return {params.count, 0.06f, 0.06f, true, fill};
}

}  // namespace mote
