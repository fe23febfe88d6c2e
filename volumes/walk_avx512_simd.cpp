#include <immintrin.h>

#include "volumes/brick_steps_simd.h"
#include "volumes/cell_steps_simd.h"
#include "volumes/lane_loads_simd.h"
#include "volumes/march_steps_simd.h"

namespace mote {
namespace {

/// The pairs at each offset, lanes 0, 1, 4, 5, 8, 9, 12, 13.
inline void even_pairs(const float* const* p, Offsets offsets, __m512* out)
{
    __m256 low[4];
    __m256 high[4];
    half_pairs(p, offsets, low);
    half_pairs(p + 8, offsets, high);
    for (int i = 0; i < 4; ++i) {
        out[i] = _mm512_insertf32x8(_mm512_castps256_ps512(low[i]), high[i], 1);
    }
}

/// v[2i], v[2i+1] = first and second float of pair i of sixteen lanes, in lane order.
inline void load_pairs(const float* const* p, Offsets offsets, __m512* v)
{
    __m512 even[4];
    __m512 odd[4];
    even_pairs(p, offsets, even);
    even_pairs(p + 2, offsets, odd);
    for (size_t i = 0; i < 4; ++i) {
        v[2 * i] = _mm512_shuffle_ps(even[i], odd[i], _MM_SHUFFLE(2, 0, 2, 0));
        v[2 * i + 1] = _mm512_shuffle_ps(even[i], odd[i], _MM_SHUFFLE(3, 1, 3, 1));
    }
}

/// Sixteen lanes.
struct Lanes {
    using Real = __m512;
    using Int = __m512i;
    using Mask = __mmask16;
    static constexpr size_t width = 16;

    static Real all(float x) { return _mm512_set1_ps(x); }
    static Real sub(Real a, Real b) { return _mm512_sub_ps(a, b); }
    static Real add(Real a, Real b) { return _mm512_add_ps(a, b); }
    static Real mul(Real a, Real b) { return _mm512_mul_ps(a, b); }
    static Real div(Real a, Real b) { return _mm512_div_ps(a, b); }
    static Real fma(Real a, Real b, Real c) { return _mm512_fmadd_ps(a, b, c); }
    static Real min(Real a, Real b) { return _mm512_min_ps(a, b); }
    static Real max(Real a, Real b) { return _mm512_max_ps(a, b); }
    static Real truncate(Real a) { return _mm512_cvtepi32_ps(_mm512_cvttps_epi32(a)); }
    static Mask less(Real a, Real b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
    static Mask less_equal(Real a, Real b) { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
    static Mask equal(Real a, Real b) { return _mm512_cmp_ps_mask(a, b, _CMP_EQ_OQ); }
    static Mask both(Mask a, Mask b) { return _kand_mask16(a, b); }
    static Mask either(Mask a, Mask b) { return _kor_mask16(a, b); }
    static Real load(const float* p) { return _mm512_loadu_ps(p); }
    static void store(float* p, Real a) { _mm512_storeu_ps(p, a); }
    static Int to_int(Real a) { return _mm512_cvttps_epi32(a); }
    static Real to_real(Int a) { return _mm512_cvtepi32_ps(a); }
    static Int count_from(int32_t a)
    {
        return _mm512_add_epi32(_mm512_set1_epi32(a), _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8,
                                                                        9, 10, 11, 12, 13, 14, 15));
    }
    static Int look_up(const BrickTable& table, Real x, Real y, Real z)
    {
        const auto mul_add = [](Int a, int32_t b, Int c) {
            return _mm512_add_epi32(_mm512_mullo_epi32(a, _mm512_set1_epi32(b)), c);
        };
        const Int row = mul_add(to_int(z), table.count[1], to_int(y));
        return _mm512_i32gather_epi32(mul_add(row, table.count[0], to_int(x)), table.entries, 4);
    }
    static bool any(Mask m) { return m != 0; }
    static Real select(Mask m, Real a, Real b) { return _mm512_mask_blend_ps(m, b, a); }
    static Real add_if(Mask m, Real a, Real b) { return _mm512_mask_add_ps(a, m, a, b); }
    static void load_pieces(const BrickPiece* pieces, const uint16_t* order, Real* field)
    {
        const float* p[16];
        for (int i = 0; i < 16; ++i) p[i] = reinterpret_cast<const float*>(&pieces[order[i]]);
        load_pairs(p, field_offsets, field);
    }
    static void scatter(Real x, const uint16_t* order, float* out)
    {
        alignas(64) float lane[16];
        _mm512_store_ps(lane, x);
        for (int i = 0; i < 16; ++i) out[order[i]] = lane[i];
    }

    /// Appends the lanes of a mask to an array.
    struct Packing {
        Mask mask;

        explicit Packing(Mask m) : mask(m) {}
        [[nodiscard]] size_t count() const { return static_cast<size_t>(__builtin_popcount(mask)); }
        void store(float* to, Real a) const
        {
            _mm512_storeu_ps(to, _mm512_maskz_compress_ps(mask, a));
        }
        void store(int32_t* to, Int a) const
        {
            _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(mask, a));
        }
    };

    /// Through memory: extracting addresses from vectors one by one costs more.
    struct Cell {
        alignas(64) const float* lane[16];

        void load_corners(Real* v)
        {
            asm("" : "+m"(lane));  // or the compiler would do just that
            load_pairs(lane, corner_offsets, v);
        }
    };

    /// A cell of each lane's brick; empty positions of the table count as brick 0.
    static Cell cells(const float* values, Int brick, Real cell)
    {
        alignas(64) int32_t bricks[width];
        alignas(64) int32_t corners[width];
        _mm512_store_si512(reinterpret_cast<__m512i*>(bricks),
                           _mm512_max_epi32(brick, _mm512_setzero_si512()));
        _mm512_store_si512(reinterpret_cast<__m512i*>(corners), to_int(cell));
        Cell at;
        for (size_t i = 0; i < width; ++i) {
            at.lane[i] = values + static_cast<ptrdiff_t>(bricks[i]) * 736 + corners[i];
        }
        return at;
    }

    struct Bases {
        alignas(64) const float* base[16];

        Bases(const float* values, const BrickPiece* pieces, const uint16_t* order)
        {
            for (int i = 0; i < 16; ++i) {
                base[i] = values + static_cast<size_t>(pieces[order[i]].brick) * 736;
            }
        }
        [[nodiscard]] Cell at(Real cell) const
        {
            const __m512i byte = _mm512_slli_epi32(_mm512_cvttps_epi32(cell), 2);
            const auto* from = reinterpret_cast<const __m512i*>(base);
            Cell at;
            auto* to = reinterpret_cast<__m512i*>(at.lane);
            to[0] = _mm512_add_epi64(_mm512_cvtepi32_epi64(_mm512_castsi512_si256(byte)), from[0]);
            to[1] = _mm512_add_epi64(_mm512_cvtepi32_epi64(_mm512_extracti64x4_epi64(byte, 1)),
                                     from[1]);
            return at;
        }
    };
};

}  // namespace

const WalkKernels avx512_walk{step_all<Lanes>, integrate_all<Lanes>, tabulate_all<Lanes>,
                              march_all<Lanes>};

}  // namespace mote
