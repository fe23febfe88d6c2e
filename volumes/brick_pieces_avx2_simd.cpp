#include <immintrin.h>

#include "volumes/brick_pieces_simd.h"

namespace mote {
namespace {

/// Where the pairs of one lane begin, next to each other in v[0] to v[7] once loaded.
struct Offsets {
    int pair[4];
};
constexpr Offsets corner_offsets{{0, 9, 81, 90}};
constexpr Offsets field_offsets{{0, 2, 4, 6}};

/// Two 8-byte pairs of floats as one vector.
inline __m128 two_pairs(const float* p, const float* q)
{
    const __m128d low = _mm_load_sd(reinterpret_cast<const double*>(p));
    return _mm_castpd_ps(_mm_loadh_pd(low, reinterpret_cast<const double*>(q)));
}

/// The pairs at each offset, lanes 0, 1 in the low half and 4, 5 in the high one.
inline void half_pairs(const float* const* p, Offsets offsets, __m256* out)
{
    for (int i = 0; i < 4; ++i) {
        const int at = offsets.pair[i];
        out[i] = _mm256_insertf128_ps(_mm256_castps128_ps256(two_pairs(p[0] + at, p[1] + at)),
                                      two_pairs(p[4] + at, p[5] + at), 1);
    }
}

/// v[2i], v[2i+1] = first and second float of pair i of eight lanes, in lane order. Eight-byte
/// loads and shuffles: a gather instruction costs more on the machines measured.
inline void load_pairs(const float* const* p, Offsets offsets, __m256* v)
{
    __m256 even[4];
    __m256 odd[4];
    half_pairs(p, offsets, even);
    half_pairs(p + 2, offsets, odd);
    for (int i = 0; i < 4; ++i) {
        v[2 * i] = _mm256_shuffle_ps(even[i], odd[i], _MM_SHUFFLE(2, 0, 2, 0));
        v[2 * i + 1] = _mm256_shuffle_ps(even[i], odd[i], _MM_SHUFFLE(3, 1, 3, 1));
    }
}

struct Lanes {
    using Real = __m256;
    using Mask = __m256;
    static constexpr size_t width = 8;

    static Real all(float x) { return _mm256_set1_ps(x); }
    static Real sub(Real a, Real b) { return _mm256_sub_ps(a, b); }
    static Real add(Real a, Real b) { return _mm256_add_ps(a, b); }
    static Real mul(Real a, Real b) { return _mm256_mul_ps(a, b); }
    static Real div(Real a, Real b) { return _mm256_div_ps(a, b); }
    static Real fma(Real a, Real b, Real c) { return _mm256_fmadd_ps(a, b, c); }
    static Real min(Real a, Real b) { return _mm256_min_ps(a, b); }
    static Real max(Real a, Real b) { return _mm256_max_ps(a, b); }
    static Real truncate(Real a) { return _mm256_cvtepi32_ps(_mm256_cvttps_epi32(a)); }
    static Mask less(Real a, Real b) { return _mm256_cmp_ps(a, b, _CMP_LT_OQ); }
    static Mask less_equal(Real a, Real b) { return _mm256_cmp_ps(a, b, _CMP_LE_OQ); }
    static Mask equal(Real a, Real b) { return _mm256_cmp_ps(a, b, _CMP_EQ_OQ); }
    static bool any(Mask m) { return _mm256_movemask_ps(m) != 0; }
    static Real select(Mask m, Real a, Real b) { return _mm256_blendv_ps(b, a, m); }
    static Real add_if(Mask m, Real a, Real b) { return _mm256_add_ps(a, _mm256_and_ps(m, b)); }
    static void load_pieces(const BrickPiece* pieces, const uint16_t* order, Real* field)
    {
        const float* p[8];
        for (int i = 0; i < 8; ++i) p[i] = reinterpret_cast<const float*>(&pieces[order[i]]);
        load_pairs(p, field_offsets, field);
    }
    static void scatter(Real x, const uint16_t* order, float* out)
    {
        alignas(32) float lane[8];
        _mm256_store_ps(lane, x);
        for (int i = 0; i < 8; ++i) out[order[i]] = lane[i];
    }

    /// Through memory: extracting addresses from vectors one by one costs more.
    struct Cell {
        alignas(32) const float* lane[8];

        void load_corners(Real* v)
        {
            asm("" : "+m"(lane));  // or the compiler would do just that
            load_pairs(lane, corner_offsets, v);
        }
    };

    struct Bases {
        alignas(32) const float* base[8];

        Bases(const float* values, const BrickPiece* pieces, const uint16_t* order)
        {
            for (int i = 0; i < 8; ++i) {
                base[i] = values + static_cast<size_t>(pieces[order[i]].brick) * 736;
            }
        }
        Cell at(Real cell) const
        {
            const __m256i byte = _mm256_slli_epi32(_mm256_cvttps_epi32(cell), 2);
            const auto* from = reinterpret_cast<const __m256i*>(base);
            Cell at;
            auto* to = reinterpret_cast<__m256i*>(at.lane);
            to[0] = _mm256_add_epi64(_mm256_cvtepi32_epi64(_mm256_castsi256_si128(byte)), from[0]);
            to[1] =
                _mm256_add_epi64(_mm256_cvtepi32_epi64(_mm256_extracti128_si256(byte, 1)), from[1]);
            return at;
        }
    };
};

}  // namespace

void integrate_pieces_avx2(const float* values, const BrickPiece* pieces, const uint16_t* order,
                           size_t count, float* integral)
{
    integrate_all<Lanes>(values, pieces, order, count, integral);
}

}  // namespace mote
