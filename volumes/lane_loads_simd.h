#pragma once

#include <immintrin.h>

// Loads that turn structures of single lanes into vectors of eight. In an unnamed namespace: each
// file of the batched walk compiles its own copy for its own machine.

namespace mote {
namespace {

/// Where the four pairs of floats of one lane begin.
struct Offsets {
    int pair[4];
};
constexpr Offsets corner_offsets{{0, 9, 81, 90}};  ///< of the eight corners of a cell
constexpr Offsets field_offsets{{0, 2, 4, 6}};     ///< of the fields of a BrickPiece

/// Two 8-byte pairs of floats as one vector.
inline __m128 two_pairs(const float* p, const float* q)
{
    const __m128i low = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(p));
    return _mm_loadh_pi(_mm_castsi128_ps(low), reinterpret_cast<const __m64*>(q));
}

/// out[i] = pair i of the lanes 0, 1 in the low half and of 4, 5 in the high one: what shuffles
/// within halves bring into lane order. Loads and shuffles, because gather instructions cost twice
/// as much on the machines measured.
inline void half_pairs(const float* const* p, Offsets offsets, __m256* out)
{
    for (int i = 0; i < 4; ++i) {
        const int at = offsets.pair[i];
        out[i] = _mm256_insertf128_ps(_mm256_castps128_ps256(two_pairs(p[0] + at, p[1] + at)),
                                      two_pairs(p[4] + at, p[5] + at), 1);
    }
}

}  // namespace
}  // namespace mote
