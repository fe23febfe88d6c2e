#include "volumes/procedural_density.h"

#include <cmath>

#include "core/rng.h"

namespace mote {
namespace {

float lattice_value(int x, int y, int z, int w, uint32_t seed)
{
    const auto word = [](int i) { return static_cast<uint32_t>(i); };
    const uint32_t h = hash32(word(x) + hash32(word(y) + hash32(word(z) + hash32(word(w) + seed))));
    return to_unit_float(h) * 2.0f - 1.0f;
}

float fade(float t)
{
    return t * t * (3.0f - 2.0f * t);
}

/// Value noise in space and phase, in [-1,1].
float noise(Vec3 p, float phase, uint32_t seed)
{
    const Vec3 floor = glm::floor(p);
    const Vec3 f = p - floor;
    const Vec3i c(floor);
    const float phase_floor = std::floor(phase);
    const int w = static_cast<int>(phase_floor);
    const float u[4] = {fade(f.x), fade(f.y), fade(f.z), fade(phase - phase_floor)};
    float sum = 0.0f;
    for (int n = 0; n < 16; ++n) {
        const int d[4] = {n & 1, n >> 1 & 1, n >> 2 & 1, n >> 3 & 1};
        float weight = 1.0f;
        for (int axis = 0; axis < 4; ++axis) weight *= d[axis] ? u[axis] : 1.0f - u[axis];
        if (weight == 0.0f) continue;
        sum += weight * lattice_value(c.x + d[0], c.y + d[1], c.z + d[2], w + d[3], seed);
    }
    return sum;
}

float smooth_step(float lo, float hi, float x)
{
    return fade(std::clamp((x - lo) / (hi - lo), 0.0f, 1.0f));
}

}  // namespace

ProceduralDensity::ProceduralDensity(const ProceduralParams& params, double time_s)
    : params_(params), phase_(static_cast<float>(static_cast<double>(params.evolve) * time_s))
{
    // Octaves down to about three voxels: finer ones would alias.
    const float smallest = std::min({params.size.x, params.size.y, params.size.z});
    const float voxels = smallest / params.voxel_size;
    octaves_ = std::clamp(static_cast<int>(std::log2(std::max(voxels / 9.0f, 1.0f))) + 1, 1, 7);
}

float ProceduralDensity::turbulence(Vec3 p, float rise) const
{
    float sum = 0.0f;
    float amplitude = 0.5f;
    float frequency = 1.0f;
    for (int octave = 0; octave < octaves_; ++octave) {
        const Vec3 q = p * frequency - Vec3(0.0f, rise, 0.0f);
        // Small eddies change faster, as the square root of their frequency.
        const float phase = phase_ * std::sqrt(frequency);
        sum += amplitude * noise(q, phase, params_.seed * 31u + static_cast<uint32_t>(octave));
        amplitude *= 0.55f;
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
    const float eroded = 1.0f - r + 1.3f * params_.noise * turbulence(p * 2.5f, 0.0f) * r;
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
    const Vec3 shifted = q - Vec3(0.0f, rise, 0.0f);
    const Vec2 axis = bend * Vec2(noise(shifted * 1.3f, 0.0f, params_.seed + 101u),
                                  noise(shifted * 1.3f, 0.0f, params_.seed + 202u));
    const float radius = 0.15f + 0.55f * std::sqrt(height);
    const float r = glm::length(Vec2(p.x, p.z) - axis) / radius;
    if (r >= 1.6f) return 0.0f;
    const float billow = 1.0f - r + 2.2f * params_.noise * turbulence(q * 3.0f, rise);
    const float edge =
        smooth_step(1.0f, 0.92f, std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}));
    return edge * (1.0f - 0.6f * height) * smooth_step(0.1f, 0.8f, billow);
}

}  // namespace mote
