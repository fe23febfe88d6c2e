#pragma once

#include <cstdint>

#include "core/math.h"

namespace mote {

/// 32-bit integer hash (PCG output permutation). Jarzynski and Olano 2020, pcg.
[[nodiscard]] inline uint32_t hash32(uint32_t v)
{
    const uint32_t state = v * 747796405u + 2891336453u;
    const uint32_t word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

[[nodiscard]] inline uint32_t hash_combine(uint32_t a, uint32_t b)
{
    return hash32(a ^ (b * 0x9e3779b9u + 0x7f4a7c15u));
}

/// Uniform float in [0, 1 - 2^-24] from 32 random bits.
[[nodiscard]] inline float to_unit_float(uint32_t bits)
{
    return static_cast<float>(bits >> 8) * 0x1p-24f;
}

/// What a stream of random numbers is for. Two purposes never share numbers.
enum class Stream : uint32_t {
    Camera,
    Path,
    Emitter,
    Test,
    Initial,
    Temporal,
    Spatial,
    Shade,
    Surface,
    SurfaceTemporal,
    SurfaceSpatial,
    ScatterNodes,
    Indirect,
    SharedPaths,
    LightGuess,
    PixelRays,
    SeenLamps,
    PathPrefix,
    PathLight,
    PathSuffix,
    PathChoice,
    PathTemporal,
    PathSpatial,
    RadianceCache,
};

/// Counter-based generator: the n-th number of a stream is a pure function of its key and n, so
/// images do not depend on thread count or order. Only 32-bit operations (shader-portable).
/// Source: pcg4d, Jarzynski and Olano 2020, "Hash Functions for GPU Rendering".
class Rng {
  public:
    /// Stream of one (seed, frame, purpose), item (pixel or particle) and sample or pass.
    Rng(uint32_t seed, uint32_t frame, Stream stream, uint32_t item, uint32_t sample)
        : key_{item, sample,
               hash_combine(hash_combine(hash32(seed), frame), static_cast<uint32_t>(stream))}
    {
    }

    /// 32 random bits.
    uint32_t next()
    {
        const uint32_t lane = counter_ & 3u;
        if (lane == 0u) refill();
        ++counter_;
        return block_[lane];
    }

    /// Uniform in [0,1).
    float uniform() { return to_unit_float(next()); }

    Vec2 uniform2()
    {
        const float x = uniform();
        return {x, uniform()};
    }

    Vec3 uniform3()
    {
        const Vec2 xy = uniform2();
        return {xy.x, xy.y, uniform()};
    }

  private:
    void refill()
    {
        uint32_t x = key_[0];
        uint32_t y = key_[1];
        uint32_t z = key_[2];
        uint32_t w = counter_ >> 2u;
        x = x * 1664525u + 1013904223u;
        y = y * 1664525u + 1013904223u;
        z = z * 1664525u + 1013904223u;
        w = w * 1664525u + 1013904223u;
        x += y * w;
        y += z * x;
        z += x * y;
        w += y * z;
        x ^= x >> 16u;
        y ^= y >> 16u;
        z ^= z >> 16u;
        w ^= w >> 16u;
        x += y * w;
        y += z * x;
        z += x * y;
        w += y * z;
        block_[0] = x;
        block_[1] = y;
        block_[2] = z;
        block_[3] = w;
    }

    uint32_t key_[3];
    uint32_t counter_ = 0;
    uint32_t block_[4]{};
};

}  // namespace mote
