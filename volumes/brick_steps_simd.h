#pragma once

#include "volumes/table_axis_simd.h"

// BrickWalk for any number of lanes; see cell_steps_simd.h for how it is instantiated.

namespace mote {

/// One axis of the walk from brick to brick.
template <class Lanes>
struct BrickAxis : TableAxis<Lanes> {
    using Base = TableAxis<Lanes>;
    using Real = typename Lanes::Real;
    using Mask = typename Lanes::Mask;
    using Base::d, Base::last, Base::o, Base::sign;

    Real c;  // this position

    BrickAxis(const RayBlock& rays, int axis, size_t i, int32_t count)
        : Base(rays.o[axis] + i, rays.d[axis] + i, rays.inv[axis] + i, count),
          c(Lanes::load(rays.cell[axis] + i))
    {
    }

    /// s at which the ray leaves the cube of positions less than `reach` away.
    [[nodiscard]] Real border(Real reach) const { return Base::border(c, reach); }

    /// Position in this brick [voxels]; rounding may not leave it.
    [[nodiscard]] Real in_brick(Real s) const
    {
        const Real origin = Lanes::mul(c, Lanes::all(8.0f));
        return clamp(Lanes::fma(s, d, Lanes::sub(o, origin)), Lanes::all(0.0f), Lanes::all(8.0f));
    }

    /// The table position after the step: across the border, or wherever s is inside the cube.
    /// Never against the ray's direction.
    [[nodiscard]] Real next(Mask crosses, Real reach, Real s) const
    {
        const Real ahead = Lanes::fma(sign, Lanes::sub(reach, Lanes::all(1.0f)), c);
        const Real there = Lanes::mul(Lanes::fma(s, d, o), Lanes::all(0.125f));
        const Real lo = Lanes::max(Lanes::min(c, ahead), Lanes::all(0.0f));
        const Real hi = Lanes::min(Lanes::max(c, ahead), last);
        return Lanes::select(crosses, Lanes::fma(sign, reach, c),
                             Lanes::truncate(clamp(there, lo, hi)));
    }

    [[nodiscard]] Mask is_outside(Real position) const
    {
        return Lanes::either(Lanes::less(position, Lanes::all(0.0f)), Lanes::less(last, position));
    }

    static Real clamp(Real x, Real lo, Real hi) { return Lanes::max(Lanes::min(x, hi), lo); }
};

/// Borders of cells between two points of a brick along one axis.
template <class Lanes>
typename Lanes::Real count_borders(typename Lanes::Real from, typename Lanes::Real to)
{
    const auto cell = [](typename Lanes::Real x) {
        const auto last = Lanes::all(7.0f);
        return Lanes::truncate(Lanes::max(Lanes::min(x, last), Lanes::all(0.0f)));
    };
    const auto n = Lanes::sub(cell(to), cell(from));
    return Lanes::max(n, Lanes::sub(Lanes::all(0.0f), n));
}

template <class Lanes>
void step_lanes(const BrickTable& table, RayBlock& rays, size_t i, int steps, PieceList& pieces)
{
    using Real = typename Lanes::Real;
    BrickAxis<Lanes> x(rays, 0, i, table.count[0]);
    BrickAxis<Lanes> y(rays, 1, i, table.count[1]);
    BrickAxis<Lanes> z(rays, 2, i, table.count[2]);
    Real s = Lanes::load(rays.s + i);
    Real s1 = Lanes::load(rays.s1 + i);
    const Real zero = Lanes::all(0.0f);
    const Real one = Lanes::all(1.0f);
    size_t count = pieces.count;
    for (int step = 0; step < steps && Lanes::any(Lanes::less(zero, s1)); ++step) {
        const auto entry = Lanes::look_up(table, x.c, y.c, z.c);
        const Real reach = Lanes::max(Lanes::sub(zero, Lanes::to_real(entry)), one);
        const Real border_x = x.border(reach);
        const Real border_y = y.border(reach);
        const Real border_z = z.border(reach);
        const Real border = Lanes::min(Lanes::min(border_x, border_y), border_z);
        const Real exit = Lanes::min(border, s1);
        const auto hits =
            Lanes::both(Lanes::less(zero, Lanes::to_real(entry)), Lanes::less(s, exit));
        const Real length = Lanes::sub(exit, s);
        const Real px = x.in_brick(s);
        const Real py = y.in_brick(s);
        const Real pz = z.in_brick(s);
        const Real borders =
            Lanes::add(Lanes::add(count_borders<Lanes>(px, Lanes::fma(length, x.d, px)),
                                  count_borders<Lanes>(py, Lanes::fma(length, y.d, py))),
                       count_borders<Lanes>(pz, Lanes::fma(length, z.d, pz)));
        const typename Lanes::Packing packing(hits);
        packing.store(pieces.p[0] + count, px);
        packing.store(pieces.p[1] + count, py);
        packing.store(pieces.p[2] + count, pz);
        packing.store(pieces.s + count, s);
        packing.store(pieces.length + count, length);
        packing.store(pieces.brick + count, entry);
        packing.store(pieces.ray + count, Lanes::count_from(static_cast<int32_t>(i)));
        packing.store(pieces.cells + count, Lanes::to_int(Lanes::add(borders, one)));
        count += packing.count();

        s = Lanes::max(s, exit);
        const Real nx = x.next(Lanes::less_equal(border_x, border), reach, s);
        const Real ny = y.next(Lanes::less_equal(border_y, border), reach, s);
        const Real nz = z.next(Lanes::less_equal(border_z, border), reach, s);
        const auto is_outside =
            Lanes::either(Lanes::either(x.is_outside(nx), y.is_outside(ny)), z.is_outside(nz));
        const auto is_done = Lanes::either(is_outside, Lanes::less_equal(s1, border));
        s1 = Lanes::select(is_done, Lanes::all(-1.0f), s1);
        x.c = Lanes::select(is_done, x.c, nx);
        y.c = Lanes::select(is_done, y.c, ny);
        z.c = Lanes::select(is_done, z.c, nz);
    }
    pieces.count = count;
    Lanes::store(rays.s + i, s);
    Lanes::store(rays.s1 + i, s1);
    Lanes::store(rays.cell[0] + i, x.c);
    Lanes::store(rays.cell[1] + i, y.c);
    Lanes::store(rays.cell[2] + i, z.c);
}

template <class Lanes>
void step_all(const BrickTable& table, RayBlock& rays, size_t count, int steps, PieceList& pieces)
{
    for (size_t i = 0; i < count; i += Lanes::width) {
        step_lanes<Lanes>(table, rays, i, steps, pieces);
    }
}

}  // namespace mote
