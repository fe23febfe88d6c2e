#include "volumes/brick_steps_simd.h"
#include "volumes/cell_steps_simd.h"
#include "volumes/march_steps_simd.h"

namespace mote {
namespace {

/// One lane: the twin that the vector forms are tested against.
struct Lanes {
    using Real = float;
    using Int = int32_t;
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
    static Mask both(Mask a, Mask b) { return a && b; }
    static Mask either(Mask a, Mask b) { return a || b; }
    static Real load(const float* p) { return *p; }
    static void store(float* p, Real a) { *p = a; }
    static Int to_int(Real a) { return static_cast<int32_t>(a); }
    static Real to_real(Int a) { return static_cast<float>(a); }
    static Int count_from(int32_t a) { return a; }
    static Int look_up(const BrickTable& table, Real x, Real y, Real z)
    {
        return table.entries[(to_int(z) * table.count[1] + to_int(y)) * table.count[0] + to_int(x)];
    }
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

    /// Appends the lanes of a mask to an array.
    struct Packing {
        bool mask;

        explicit Packing(Mask m) : mask(m) {}
        [[nodiscard]] size_t count() const { return mask ? 1 : 0; }
        template <class T>
        void store(T* to, T a) const
        {
            *to = a;
        }
    };

    struct Cell {
        const float* corner;

        void load_corners(Real* v) const
        {
            constexpr int offset[8] = {0, 1, 9, 10, 81, 82, 90, 91};
            for (int i = 0; i < 8; ++i) v[i] = corner[offset[i]];
        }
    };

    /// A cell of a brick; empty positions of the table count as brick 0.
    static Cell cells(const float* values, Int brick, Real cell)
    {
        return {values + static_cast<ptrdiff_t>(brick > 0 ? brick : 0) * 736 +
                static_cast<int>(cell)};
    }

    struct Bases {
        const float* base;

        Bases(const float* values, const BrickPiece* pieces, const uint16_t* order)
            : base(values + static_cast<size_t>(pieces[order[0]].brick) * 736)
        {
        }
        [[nodiscard]] Cell at(Real cell) const { return {base + static_cast<int>(cell)}; }
    };
};

}  // namespace

const WalkKernels scalar_walk{step_all<Lanes>, integrate_all<Lanes>, tabulate_all<Lanes>,
                              march_all<Lanes>};

}  // namespace mote
