#include "volumes/brick_pieces_simd.h"

namespace mote {
namespace {

/// One lane: the twin that the vector forms are tested against.
struct Lanes {
    using Real = float;
    using Mask = bool;
    static constexpr size_t width = 1;

    static Real all(float x) { return x; }
    static Real sub(Real a, Real b) { return a - b; }
    static Real add(Real a, Real b) { return a + b; }
    static Real mul(Real a, Real b) { return a * b; }
    static Real div(Real a, Real b) { return a / b; }
    static Real fma(Real a, Real b, Real c) { return __builtin_fmaf(a, b, c); }
    static Real min(Real a, Real b) { return a < b ? a : b; }
    static Real max(Real a, Real b) { return a > b ? a : b; }
    static Real truncate(Real a) { return static_cast<float>(static_cast<int>(a)); }
    static Mask less(Real a, Real b) { return a < b; }
    static Mask less_equal(Real a, Real b) { return a <= b; }
    static Mask equal(Real a, Real b) { return a == b; }
    static bool any(Mask m) { return m; }
    static Real select(Mask m, Real a, Real b) { return m ? a : b; }
    static Real add_if(Mask m, Real a, Real b) { return m ? a + b : a; }
    static void load_pieces(const BrickPiece* pieces, const uint16_t* order, Real* field)
    {
        const BrickPiece& piece = pieces[order[0]];
        for (int i = 0; i < 3; ++i) {
            field[i] = piece.p[i];
            field[4 + i] = piece.d[i];
        }
        field[3] = piece.length;
    }
    static void scatter(Real x, const uint16_t* order, float* out) { out[order[0]] = x; }

    struct Cell {
        const float* corner;

        void load_corners(Real* v) const
        {
            constexpr int offset[8] = {0, 1, 9, 10, 81, 82, 90, 91};
            for (int i = 0; i < 8; ++i) v[i] = corner[offset[i]];
        }
    };

    struct Bases {
        const float* base;

        Bases(const float* values, const BrickPiece* pieces, const uint16_t* order)
            : base(values + static_cast<size_t>(pieces[order[0]].brick) * 736)
        {
        }
        Cell at(Real cell) const { return {base + static_cast<int>(cell)}; }
    };
};

}  // namespace

void integrate_pieces_scalar(const float* values, const BrickPiece* pieces, const uint16_t* order,
                             size_t count, float* integral)
{
    integrate_all<Lanes>(values, pieces, order, count, integral);
}

}  // namespace mote
