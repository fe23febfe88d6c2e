#include <immintrin.h>

#include "volumes/brick_steps_simd.h"
#include "volumes/cell_steps_simd.h"
#include "volumes/lane_loads_simd.h"
#include "volumes/march_steps_simd.h"

namespace mote {
namespace {

/// v[2i], v[2i+1] = first and second float of pair i of eight lanes, in lane order.
inline void load_pairs(const float* const* p, Offsets offsets, __m256* v)
{
    __m256 even[4];
    __m256 odd[4];
    half_pairs(p, offsets, even);
    half_pairs(p + 2, offsets, odd);
    for (size_t i = 0; i < 4; ++i) {
        v[2 * i] = _mm256_shuffle_ps(even[i], odd[i], _MM_SHUFFLE(2, 0, 2, 0));
        v[2 * i + 1] = _mm256_shuffle_ps(even[i], odd[i], _MM_SHUFFLE(3, 1, 3, 1));
    }
}

/// For each mask of eight lanes, the numbers of those that are set, next to each other.
struct PackingTable {
    uint8_t from[256][8] = {};

    constexpr PackingTable()
    {
        for (int mask = 0; mask < 256; ++mask) {
            int n = 0;
            for (int lane = 0; lane < 8; ++lane) {
                if ((mask >> lane & 1) != 0) from[mask][n++] = static_cast<uint8_t>(lane);
            }
        }
    }
};
constexpr PackingTable packing_table;

/// Eight lanes.
struct Lanes {
    using Real = __m256;
    using Int = __m256i;
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
    static Mask both(Mask a, Mask b) { return _mm256_and_ps(a, b); }
    static Mask either(Mask a, Mask b) { return _mm256_or_ps(a, b); }
    static Real load(const float* p) { return _mm256_loadu_ps(p); }
    static void store(float* p, Real a) { _mm256_storeu_ps(p, a); }
    static Int to_int(Real a) { return _mm256_cvttps_epi32(a); }
    static Real to_real(Int a) { return _mm256_cvtepi32_ps(a); }
    static Int count_from(int32_t a)
    {
        return _mm256_add_epi32(_mm256_set1_epi32(a), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
    }
    static Int look_up(const BrickTable& table, Real x, Real y, Real z)
    {
        const auto mul_add = [](Int a, int32_t b, Int c) {
            return _mm256_add_epi32(_mm256_mullo_epi32(a, _mm256_set1_epi32(b)), c);
        };
        const Int row = mul_add(to_int(z), table.count[1], to_int(y));
        return _mm256_i32gather_epi32(table.entries, mul_add(row, table.count[0], to_int(x)), 4);
    }
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

    /// Appends the lanes of a mask to an array.
    struct Packing {
        unsigned mask;
        __m256i from;

        explicit Packing(Mask m) : mask(static_cast<unsigned>(_mm256_movemask_ps(m)))
        {
            const auto* bytes = reinterpret_cast<const __m128i*>(packing_table.from[mask]);
            from = _mm256_cvtepu8_epi32(_mm_loadl_epi64(bytes));
        }
        [[nodiscard]] size_t count() const { return static_cast<size_t>(__builtin_popcount(mask)); }
        void store(float* to, Real a) const
        {
            _mm256_storeu_ps(to, _mm256_permutevar8x32_ps(a, from));
        }
        void store(int32_t* to, Int a) const
        {
            _mm256_storeu_si256(reinterpret_cast<__m256i*>(to),
                                _mm256_permutevar8x32_epi32(a, from));
        }
    };

    /// Through memory: extracting addresses from vectors one by one costs more.
    struct Cell {
        alignas(32) const float* lane[8];

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
        _mm256_store_si256(reinterpret_cast<__m256i*>(bricks),
                           _mm256_max_epi32(brick, _mm256_setzero_si256()));
        _mm256_store_si256(reinterpret_cast<__m256i*>(corners), to_int(cell));
        Cell at;
        for (size_t i = 0; i < width; ++i) {
            at.lane[i] = values + static_cast<ptrdiff_t>(bricks[i]) * 736 + corners[i];
        }
        return at;
    }

    struct Bases {
        alignas(32) const float* base[8];

        Bases(const float* values, const BrickPiece* pieces, const uint16_t* order)
        {
            for (int i = 0; i < 8; ++i) {
                base[i] = values + static_cast<size_t>(pieces[order[i]].brick) * 736;
            }
        }
        [[nodiscard]] Cell at(Real cell) const
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

const WalkKernels avx2_walk{step_all<Lanes>, integrate_all<Lanes>, tabulate_all<Lanes>,
                            march_all<Lanes>};

}  // namespace mote
