#pragma once

#include "volumes/table_axis_simd.h"

// Rays marched side by side; see cell_steps_simd.h for how it is instantiated, and for
// interpolate().

namespace mote {

/// One axis of a march.
template <class Lanes>
struct MarchAxis : TableAxis<Lanes> {
    using Base = TableAxis<Lanes>;
    using Real = typename Lanes::Real;
    using Base::d, Base::last, Base::o;

    MarchAxis(const MarchBlock& rays, int axis, size_t i, int32_t count)
        : Base(rays.o[axis] + i, rays.d[axis] + i, rays.inv[axis] + i, count)
    {
    }

    [[nodiscard]] Real at(Real s) const { return Lanes::fma(s, d, o); }

    /// Position in the table of a point, kept inside of it.
    [[nodiscard]] Real brick(Real p) const
    {
        const Real b = Lanes::mul(p, Lanes::all(0.125f));
        return Lanes::truncate(Lanes::max(Lanes::min(b, last), Lanes::all(0.0f)));
    }

    /// Cell of a point in its brick.
    static Real cell(Real in_brick)
    {
        return Lanes::truncate(
            Lanes::max(Lanes::min(in_brick, Lanes::all(7.0f)), Lanes::all(0.0f)));
    }
};

/// Density at the middles of equal steps; empty positions of the table are jumped over by whole
/// steps.
template <class Lanes>
void march_lanes(const BrickTable& table, const float* values, const MarchBlock& rays, size_t i,
                 float* integral, float* lookups)
{
    using Real = typename Lanes::Real;
    using Mask = typename Lanes::Mask;
    using Axis = MarchAxis<Lanes>;
    const Axis x(rays, 0, i, table.count[0]);
    const Axis y(rays, 1, i, table.count[1]);
    const Axis z(rays, 2, i, table.count[2]);
    const Real zero = Lanes::all(0.0f);
    const Real one = Lanes::all(1.0f);
    const Real eight = Lanes::all(8.0f);
    const Real nine = Lanes::all(9.0f);
    const Real step = Lanes::load(rays.step + i);
    const Real per_step = Lanes::div(one, step);
    const Real most = Lanes::mul(Lanes::load(rays.limit + i), per_step);
    const Real end = Lanes::load(rays.s1 + i);
    Real s = Lanes::mul(step, Lanes::all(0.5f));
    Real sum = zero;
    Real taken = zero;
    for (Mask active = Lanes::less(s, end); Lanes::any(active);
         active = Lanes::both(Lanes::less(s, end), Lanes::less_equal(sum, most))) {
        const Real px = x.at(s);
        const Real py = y.at(s);
        const Real pz = z.at(s);
        const Real bx = x.brick(px);
        const Real by = y.brick(py);
        const Real bz = z.brick(pz);
        const auto entry = Lanes::look_up(table, bx, by, bz);
        const Real number = Lanes::to_real(entry);
        const Mask full = Lanes::both(active, Lanes::less(zero, number));
        if (Lanes::any(full)) {
            const Real lx = Lanes::sub(px, Lanes::mul(bx, eight));
            const Real ly = Lanes::sub(py, Lanes::mul(by, eight));
            const Real lz = Lanes::sub(pz, Lanes::mul(bz, eight));
            const Real cx = Axis::cell(lx);
            const Real cy = Axis::cell(ly);
            const Real cz = Axis::cell(lz);
            const Real corner = Lanes::fma(Lanes::fma(cx, nine, cy), nine, cz);
            Real v[8];
            Lanes::cells(values, entry, corner).load_corners(v);
            Real dz[4];
            for (int j = 0; j < 4; ++j) dz[j] = Lanes::sub(v[2 * j + 1], v[2 * j]);
            const Real value = interpolate<Lanes>(v, dz, Lanes::sub(lx, cx), Lanes::sub(ly, cy),
                                                  Lanes::sub(lz, cz));
            sum = Lanes::add_if(full, sum, value);
            taken = Lanes::add_if(full, taken, one);
        }
        const Mask empty = Lanes::both(active, Lanes::less_equal(number, zero));
        Real steps = one;
        if (Lanes::any(empty)) {
            const Real reach = Lanes::max(Lanes::sub(zero, number), one);
            const Real border = Lanes::min(Lanes::min(x.border(bx, reach), y.border(by, reach)),
                                           Lanes::min(z.border(bz, reach), end));
            const Real rest = Lanes::mul(Lanes::max(Lanes::sub(border, s), zero), per_step);
            steps = Lanes::select(empty, Lanes::add(Lanes::truncate(rest), one), one);
        }
        s = Lanes::fma(steps, step, s);
    }
    Lanes::store(integral + i, Lanes::mul(sum, step));
    Lanes::store(lookups + i, taken);
}

template <class Lanes>
void march_all(const BrickTable& table, const float* values, const MarchBlock& rays, size_t count,
               float* integral, float* lookups)
{
    for (size_t i = 0; i < count; i += Lanes::width) {
        march_lanes<Lanes>(table, values, rays, i, integral, lookups);
    }
}

}  // namespace mote
