// Procedural densities against the same formulas written out, without what is left out or shared
// to save time: bit for bit.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/rng.h"
#include "volumes/procedural_density.h"

namespace mote {
namespace {

float fade(float t)
{
    return t * t * (3.0f - 2.0f * t);
}

float smooth_step(float lo, float hi, float x)
{
    return fade(std::clamp((x - lo) / (hi - lo), 0.0f, 1.0f));
}

/// Value noise: the 16 corners, weighted, each a hash of its own.
float plain_noise(Vec3 p, float phase, uint32_t seed)
{
    const float at[4] = {p.x, p.y, p.z, phase};
    float sum = 0.0f;
    for (int n = 0; n < 16; ++n) {
        float weight = 1.0f;
        uint32_t corner[4];
        for (int axis = 0; axis < 4; ++axis) {
            const float floor = std::floor(at[axis]);
            const float u = fade(at[axis] - floor);
            const int step = n >> axis & 1;
            weight *= step == 1 ? u : 1.0f - u;
            corner[axis] = static_cast<uint32_t>(static_cast<int>(floor) + step);
        }
        const uint32_t h =
            hash32(corner[0] + hash32(corner[1] + hash32(corner[2] + hash32(corner[3] + seed))));
        sum += weight * (to_unit_float(h) * 2.0f - 1.0f);
    }
    return sum;
}

float plain_turbulence(const ProceduralParams& params, Vec3 p, float rise, float phase)
{
    const float smallest = std::min({params.size.x, params.size.y, params.size.z});
    const float octaves = std::floor(std::log2(std::max(smallest / params.voxel_size / 9, 1.0f)));
    float sum = 0.0f;
    float amplitude = 0.5f;
    float frequency = 1.0f;
    for (uint32_t octave = 0; octave <= static_cast<uint32_t>(octaves); ++octave) {
        sum += amplitude * plain_noise(p * frequency - Vec3(0.0f, rise, 0.0f),
                                       phase * std::sqrt(frequency), params.seed * 31u + octave);
        amplitude *= 0.55f;
        frequency *= 2.03f;
    }
    return sum;
}

float plain_puff(const ProceduralParams& params, Vec3 p, float phase)
{
    const float r = glm::length(p);
    if (r >= 1.0f) return 0.0f;
    const float turbulence = plain_turbulence(params, p * 2.5f, 0.0f, phase);
    return smooth_step(0.0f, 0.75f, 1.0f - r + 1.3f * params.noise * turbulence * r) *
           smooth_step(1.0f, 0.9f, r);
}

float plain_plume(const ProceduralParams& params, Vec3 p, float phase)
{
    const float height = 0.5f * (p.y + 1.0f);
    const float rise = 1.5f * phase;
    const Vec3 q = p * Vec3(1.0f, params.size.y / std::max(params.size.x, params.size.z), 1.0f);
    const Vec3 bent = (q - Vec3(0.0f, rise, 0.0f)) * 1.3f;
    const Vec2 axis =
        0.35f * params.noise * height *
        Vec2(plain_noise(bent, 0, params.seed + 101u), plain_noise(bent, 0, params.seed + 202u));
    const float r = glm::length(Vec2(p.x, p.z) - axis) / (0.15f + 0.55f * std::sqrt(height));
    if (r >= 1.6f) return 0.0f;
    const float turbulence = plain_turbulence(params, q * 3.0f, rise, phase);
    const float side = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return smooth_step(1.0f, 0.92f, side) * (1.0f - 0.6f * height) *
           smooth_step(0.1f, 0.8f, 1.0f - r + 2.2f * params.noise * turbulence);
}

TEST(ProceduralDensity, IsItsFormulaBitForBit)
{
    for (const ProceduralKind kind : {ProceduralKind::Puff, ProceduralKind::Plume}) {
        for (const float noise : {0.0f, 0.4f, 1.0f}) {
            for (const double time_s : {0.0, 1.7}) {
                ProceduralParams params;
                params.kind = kind;
                params.size = Vec3(1.0f, 2.0f, 1.0f);
                params.voxel_size = 0.01f;
                params.noise = noise;
                params.evolve = 0.8f;
                params.seed = 5;
                const ProceduralDensity density(params, time_s);
                const auto phase = static_cast<float>(static_cast<double>(params.evolve) * time_s);
                int smoke = 0;
                for (uint32_t i = 0; i < 4000; ++i) {
                    Rng rng(1, 0, Stream::Test, i, 0);
                    const Vec3i voxel(rng.uniform3() * Vec3(100.0f, 200.0f, 100.0f));
                    const Vec3 p = (Vec3(voxel) + 0.5f) * params.voxel_size / (0.5f * params.size) -
                                   Vec3(1.0f);
                    const float expected = kind == ProceduralKind::Puff
                                               ? plain_puff(params, p, phase)
                                               : plain_plume(params, p, phase);
                    ASSERT_EQ(density.at(voxel), expected)
                        << voxel.x << ' ' << voxel.y << ' ' << voxel.z << ", noise " << noise;
                    smoke += expected > 0.0f ? 1 : 0;
                }
                EXPECT_GT(smoke, 400);
            }
        }
    }
}

}  // namespace
}  // namespace mote
