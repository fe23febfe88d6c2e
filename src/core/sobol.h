#pragma once

#include "core/rng.h"

namespace mote {

[[nodiscard]] inline uint32_t reverse_bits(uint32_t v)
{
    v = (v >> 1u & 0x55555555u) | (v & 0x55555555u) << 1u;
    v = (v >> 2u & 0x33333333u) | (v & 0x33333333u) << 2u;
    v = (v >> 4u & 0x0f0f0f0fu) | (v & 0x0f0f0f0fu) << 4u;
    return __builtin_bswap32(v);
}

/// Nested uniform (Owen) scrambling by a hash in which bits depend on the higher ones alone.
/// Source: Burley 2020, "Practical Hash-based Owen Scrambling", JCGT 9(4), after Laine and Karras.
[[nodiscard]] inline uint32_t owen_scramble(uint32_t v, uint32_t seed)
{
    v = reverse_bits(v);
    v ^= v * 0x3d20adeau;
    v += seed;
    v *= (seed >> 16u) | 1u;
    v ^= v * 0x05526c56u;
    v ^= v * 0x53a22864u;
    return reverse_bits(v);
}

/// First two dimensions of Sobol's sequence, unscrambled.
[[nodiscard]] inline uint32_t sobol_x(uint32_t index)
{
    return reverse_bits(index);
}
[[nodiscard]] inline uint32_t sobol_y(uint32_t index)
{
    uint32_t sum = 0;
    for (uint32_t column = 1u << 31u; index != 0; index >>= 1u, column ^= column >> 1u) {
        if ((index & 1u) != 0) sum ^= column;
    }
    return sum;
}

/// Well-spread numbers over the passes of a pixel, in pairs: shuffled, scrambled Sobol points. Any
/// one pass sees independent uniform numbers; together the passes of a pixel fill each pair's
/// square evenly, so that a mean over N of them converges faster than with independent numbers.
/// Pairs are independent of each other. 32-bit operations only.
class PassSequence {
  public:
    /// `key` separates pixels, frames and seeds; `pass` counts from 0.
    PassSequence(uint32_t key, uint32_t pass) : key_(key), pass_(pass) {}

    /// The pair number `pair`, in [0,1)^2.
    [[nodiscard]] Vec2 pair(uint32_t pair) const
    {
        const uint32_t seed = hash_combine(key_, pair);
        const uint32_t index = owen_scramble(reverse_bits(pass_), hash32(seed ^ 0x68bc21ebu));
        const uint32_t shuffled = reverse_bits(index);
        return {to_unit_float(owen_scramble(sobol_x(shuffled), hash32(seed ^ 0x02e5be93u))),
                to_unit_float(owen_scramble(sobol_y(shuffled), hash32(seed ^ 0x967a889bu)))};
    }

  private:
    uint32_t key_;
    uint32_t pass_;
};

}  // namespace mote
