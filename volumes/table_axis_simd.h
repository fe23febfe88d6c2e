#pragma once

#include "volumes/walk_kernels.h"

// See cell_steps_simd.h for how it is instantiated.

namespace mote {

/// One axis of rays on their ways through a table of bricks, side by side.
template <class Lanes>
struct TableAxis {
    using Real = typename Lanes::Real;
    using Mask = typename Lanes::Mask;

    Real o, d, inv;
    Real sign;   // of the direction, -1 for 0
    Real first;  // 0 upwards, 1 downwards: the low border of `reach` positions counts from there
    Real last;   // position of the table
    Mask moves;

    TableAxis(const float* origins, const float* directions, const float* inverses, int32_t count)
        : o(Lanes::load(origins)), d(Lanes::load(directions)), inv(Lanes::load(inverses))
    {
        const Real zero = Lanes::all(0.0f);
        const Real one = Lanes::all(1.0f);
        const Mask is_up = Lanes::less(zero, d);
        sign = Lanes::select(is_up, one, Lanes::all(-1.0f));
        first = Lanes::select(is_up, zero, one);
        last = Lanes::all(static_cast<float>(count - 1));
        moves = Lanes::less(zero, Lanes::mul(inv, sign));
    }

    /// s at which the ray leaves the cube of positions less than `reach` away from position b.
    [[nodiscard]] Real border(Real b, Real reach) const
    {
        const Real plane = Lanes::fma(sign, reach, Lanes::add(b, first));
        const Real s = Lanes::mul(Lanes::sub(Lanes::mul(plane, Lanes::all(8.0f)), o), inv);
        return Lanes::select(moves, s, Lanes::all(1e38f));
    }
};

}  // namespace mote
