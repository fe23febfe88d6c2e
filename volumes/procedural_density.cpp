#include "volumes/procedural_density.h"

#include <cmath>

#include "core/rng.h"

namespace mote {
namespace {

float fade(float t)
{
    return t * t * (3.0f - 2.0f * t);
}

/// Value noise in space and phase, in [-1,1]. A corner's value is a hash of x on a hash of y on one
/// of z on one of w, so that corners share all but the last.
float noise(Vec3 p, float phase, uint32_t seed)
{
    const Vec3 floor = glm::floor(p);
    const Vec3 f = p - floor;
    const Vec3i c(floor);
    const float phase_floor = std::floor(phase);
    const Vec3 u(fade(f.x), fade(f.y), fade(f.z));
    const Vec3 v = 1.0f - u;
    const float late = fade(phase - phase_floor);
    const float weight_yx[4] = {v.x * v.y, u.x * v.y, v.x * u.y, u.x * u.y};
    const uint32_t x[2] = {static_cast<uint32_t>(c.x), static_cast<uint32_t>(c.x + 1)};
    const uint32_t y[2] = {static_cast<uint32_t>(c.y), static_cast<uint32_t>(c.y + 1)};
    const uint32_t z[2] = {static_cast<uint32_t>(c.z), static_cast<uint32_t>(c.z + 1)};
    float sum = 0.0f;
    for (int when = 0; when < 2; ++when) {
        const float weight_w = when == 0 ? 1.0f - late : late;
        if (weight_w == 0.0f) continue;
        const auto w = static_cast<uint32_t>(static_cast<int>(phase_floor) + when);
        const uint32_t on_w = hash32(w + seed);
        const uint32_t on_z[2] = {hash32(z[0] + on_w), hash32(z[1] + on_w)};
        uint32_t on_y[4];
        for (int n = 0; n < 4; ++n) on_y[n] = hash32(y[n & 1] + on_z[n >> 1]);
        float terms[8];
        for (int n = 0; n < 8; ++n) {
            const float value = to_unit_float(hash32(x[n & 1] + on_y[n >> 1])) * 2.0f - 1.0f;
            terms[n] = weight_yx[n & 3] * (n < 4 ? v.z : u.z) * weight_w * value;
        }
        for (const float term : terms) sum += term;
    }
    return sum;
}

float smooth_step(float lo, float hi, float x)
{
    return fade(std::clamp((x - lo) / (hi - lo), 0.0f, 1.0f));
}

}  // namespace

ProceduralDensity::Range ProceduralDensity::range_between(float lo, float hi, float offset,
                                                          float scale)
{
    if (!(scale > 0.0f)) return {infinity, -infinity};  // nowhere
    return {(lo - offset) / scale, (hi - offset) / scale};
}

ProceduralDensity::ProceduralDensity(const ProceduralParams& params, double time_s)
    : params_(params), phase_(static_cast<float>(static_cast<double>(params.evolve) * time_s))
{
    // Octaves down to about three voxels: finer ones would alias.
    const float smallest = std::min({params.size.x, params.size.y, params.size.z});
    const float voxels = smallest / params.voxel_size;
    octaves_ = std::clamp(static_cast<int>(std::log2(std::max(voxels / 9.0f, 1.0f))) + 1, 1, 7);
}

float ProceduralDensity::turbulence(Vec3 p, float rise, Range matters) const
{
    constexpr float gain = 0.55f;
    constexpr float rounding = 1e-4f;
    float sum = 0.0f;
    float amplitude = 0.5f;
    float frequency = 1.0f;
    for (int octave = 0; octave < octaves_; ++octave) {
        const float rest = amplitude / (1.0f - gain) + rounding;  // of any number of octaves
        if (sum + rest < matters.lo || sum - rest > matters.hi) break;
        const Vec3 q = p * frequency - Vec3(0.0f, rise, 0.0f);
        // Small eddies change faster, as the square root of their frequency.
        const float phase = phase_ * std::sqrt(frequency);
        sum += amplitude * noise(q, phase, params_.seed * 31u + static_cast<uint32_t>(octave));
        amplitude *= gain;
        frequency *= 2.03f;
    }
    return sum;
}

float ProceduralDensity::at(Vec3i voxel) const
{
    if (params_.kind == ProceduralKind::Box) return box(voxel);
    // In units of the half extents, so that every shape fills [-1,1]^3.
    const Vec3 p = (Vec3(voxel) + 0.5f) * params_.voxel_size / (0.5f * params_.size) - Vec3(1.0f);
    switch (params_.kind) {
        case ProceduralKind::Sphere:
            return sphere(p);
        case ProceduralKind::Plume:
            return plume(p);
        default:
            return puff(p);
    }
}

float ProceduralDensity::box(Vec3i voxel) const
{
    float share = 1.0f;
    for (int axis = 0; axis < 3; ++axis) {
        const float edge = params_.size[axis] / params_.voxel_size;
        share *= std::clamp(edge - static_cast<float>(voxel[axis]), 0.0f, 1.0f);
    }
    return share;
}

float ProceduralDensity::sphere(Vec3 p) const
{
    const float smallest = std::min({params_.size.x, params_.size.y, params_.size.z});
    const float radius_voxels = 0.5f * smallest / params_.voxel_size;
    return std::clamp(0.5f + (1.0f - glm::length(p)) * radius_voxels, 0.0f, 1.0f);
}

float ProceduralDensity::puff(Vec3 p) const
{
    const float r = glm::length(p);
    if (r >= 1.0f) return 0.0f;
    const float depth = 1.3f * params_.noise;
    const Range matters = range_between(0.0f, 0.75f, 1.0f - r, depth * r);
    const float eroded = 1.0f - r + depth * turbulence(p * 2.5f, 0.0f, matters) * r;
    return smooth_step(0.0f, 0.75f, eroded) * smooth_step(1.0f, 0.9f, r);
}

float ProceduralDensity::plume(Vec3 p) const
{
    const float height = 0.5f * (p.y + 1.0f);  // 0 at the source, 1 at the top
    const float aspect = params_.size.y / std::max(params_.size.x, params_.size.z);
    const Vec3 q = p * Vec3(1.0f, aspect, 1.0f);
    // The axis meanders more and the column widens as it rises; phase moves the eddies upwards.
    const float rise = 1.5f * phase_;
    const float bend = 0.35f * params_.noise * height;
    const float radius = 0.15f + 0.55f * std::sqrt(height);
    constexpr float widest = 1.6f;  // radii; and of the axis no coordinate exceeds `bend`
    if (glm::length(Vec2(p.x, p.z)) > 1.5f * bend + widest * radius) return 0.0f;
    const Vec3 shifted = q - Vec3(0.0f, rise, 0.0f);
    const Vec2 axis = bend * Vec2(noise(shifted * 1.3f, 0.0f, params_.seed + 101u),
                                  noise(shifted * 1.3f, 0.0f, params_.seed + 202u));
    const float r = glm::length(Vec2(p.x, p.z) - axis) / radius;
    if (r >= widest) return 0.0f;
    const float depth = 2.2f * params_.noise;
    const Range matters = range_between(0.1f, 0.8f, 1.0f - r, depth);
    const float billow = 1.0f - r + depth * turbulence(q * 3.0f, rise, matters);
    const float edge =
        smooth_step(1.0f, 0.92f, std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}));
    return edge * (1.0f - 0.6f * height) * smooth_step(0.1f, 0.8f, billow);
}

}  // namespace mote
