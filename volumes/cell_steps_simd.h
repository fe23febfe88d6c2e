#pragma once

#include "volumes/walk_kernels.h"

// The closed-form walk of BrickPieces, written once for any number of lanes. Each instruction set
// instantiates it in a file of its own with a `Lanes` type from an anonymous namespace, so that no
// function compiled for one machine can be linked into code for another. For the same reason there
// are no includes but plain data here.

namespace mote {

/// One axis of the walk through the cells of a brick.
template <class Lanes>
struct CellAxis {
    using Real = typename Lanes::Real;

    Real p, d;
    Real step;  // of the cell coordinate: +1 or -1
    Real minus_inv;
    Real up_inv;  // s at which cell c is left: (c + up - p) / d, up = 0 or 1
    Real last;    // the brick's last cell in this direction; left only by the end of the piece
    Real c;       // this cell
    Real g;       // p - c

    CellAxis(Real p_, Real d_) : p(p_), d(d_)
    {
        const Real zero = Lanes::all(0.0f);
        const Real one = Lanes::all(1.0f);
        const Real tiny = Lanes::all(1e-30f);
        const auto is_up = Lanes::less(zero, d);
        const auto moves = Lanes::less(tiny, Lanes::max(d, Lanes::sub(zero, d)));
        const Real inv = Lanes::select(moves, Lanes::div(one, d), zero);
        step = Lanes::select(is_up, one, Lanes::all(-1.0f));
        minus_inv = Lanes::sub(zero, inv);
        up_inv = Lanes::select(moves, Lanes::select(is_up, inv, zero), Lanes::all(1e38f));
        last = Lanes::select(is_up, Lanes::all(7.0f), zero);
        c = Lanes::truncate(Lanes::max(Lanes::min(p, Lanes::all(7.0f)), zero));
        g = Lanes::sub(p, c);
    }

    /// s at which the ray leaves this cell through this axis.
    [[nodiscard]] Real exit() const
    {
        const Real s = Lanes::fma(g, minus_inv, up_inv);
        return Lanes::select(Lanes::equal(c, last), Lanes::all(1e38f), s);
    }

    void advance(typename Lanes::Mask crosses)
    {
        c = Lanes::add_if(crosses, c, step);
        g = Lanes::sub(p, c);
    }

    /// Position inside the cell.
    [[nodiscard]] Real at(Real s) const { return Lanes::fma(s, d, g); }
};

/// Trilinear value at (x, y, z) in [0,1]^3; v[i] at corner i, z the low bit, x the high one; `dz`
/// are the differences along z.
template <class Lanes>
typename Lanes::Real interpolate(const typename Lanes::Real* v, const typename Lanes::Real* dz,
                                 typename Lanes::Real x, typename Lanes::Real y,
                                 typename Lanes::Real z)
{
    using Real = typename Lanes::Real;
    const Real v00 = Lanes::fma(z, dz[0], v[0]);
    const Real v01 = Lanes::fma(z, dz[1], v[2]);
    const Real v10 = Lanes::fma(z, dz[2], v[4]);
    const Real v11 = Lanes::fma(z, dz[3], v[6]);
    const Real v0 = Lanes::fma(y, Lanes::sub(v01, v00), v00);
    const Real v1 = Lanes::fma(y, Lanes::sub(v11, v10), v10);
    return Lanes::fma(x, Lanes::sub(v1, v0), v0);
}

/// One group of pieces side by side; on_cell(s, integral) at the end of every cell. Inside a cell
/// the density is a cubic in s, so two Gauss points integrate it exactly; unlike Simpson's rule
/// they need nothing from the cell before.
template <class Lanes, class OnCell>
typename Lanes::Real integrate_lanes(const float* values, const BrickPiece* pieces,
                                     const uint16_t* order, OnCell&& on_cell)
{
    using Real = typename Lanes::Real;
    Real field[8];
    Lanes::load_pieces(pieces, order, field);
    const typename Lanes::Bases bases(values, pieces, order);
    CellAxis<Lanes> x(field[0], field[4]);
    CellAxis<Lanes> y(field[1], field[5]);
    CellAxis<Lanes> z(field[2], field[6]);
    const Real length = field[3];
    const Real nine = Lanes::all(9.0f);
    const Real low_node = Lanes::all(0.21132487f);  // (1 - 1/sqrt(3)) / 2
    const Real high_node = Lanes::all(0.78867513f);
    Real s = Lanes::all(0.0f);
    Real sum = Lanes::all(0.0f);
    // A cell border is crossed, or the end reached, in every round: at most 22 rounds. The next
    // cell's address is computed a round ahead, or its latency would be in the way of everything.
    auto cell = bases.at(Lanes::fma(Lanes::fma(x.c, nine, y.c), nine, z.c));
    while (Lanes::any(Lanes::less(s, length))) {
        const Real exit_x = x.exit();
        const Real exit_y = y.exit();
        const Real exit_z = z.exit();
        const Real exit = Lanes::min(Lanes::min(exit_x, exit_y), Lanes::min(exit_z, length));
        const Real end = Lanes::max(exit, s);
        const Real span = Lanes::sub(end, s);
        const Real a = Lanes::fma(span, low_node, s);
        const Real b = Lanes::fma(span, high_node, s);
        const Real xa = x.at(a), ya = y.at(a), za = z.at(a);
        const Real xb = x.at(b), yb = y.at(b), zb = z.at(b);
        Real v[8];
        cell.load_corners(v);
        x.advance(Lanes::less_equal(exit_x, end));
        y.advance(Lanes::less_equal(exit_y, end));
        z.advance(Lanes::less_equal(exit_z, end));
        s = end;
        cell = bases.at(Lanes::fma(Lanes::fma(x.c, nine, y.c), nine, z.c));
        Real dz[4];
        for (int i = 0; i < 4; ++i) dz[i] = Lanes::sub(v[2 * i + 1], v[2 * i]);
        const Real at_a = interpolate<Lanes>(v, dz, xa, ya, za);
        const Real at_b = interpolate<Lanes>(v, dz, xb, yb, zb);
        sum = Lanes::fma(span, Lanes::add(at_a, at_b), sum);
        on_cell(s, sum);
    }
    return Lanes::mul(sum, Lanes::all(0.5f));
}

/// Asks for the first cells of a group that is next. Measured: 6 % of the whole walk.
template <class Lanes>
void prefetch_lanes(const float* values, const BrickPiece* pieces, const uint16_t* order)
{
    for (size_t i = 0; i < Lanes::width; ++i) {
        const BrickPiece& piece = pieces[order[i]];
        const auto x = static_cast<size_t>(piece.p[0]);
        const auto y = static_cast<size_t>(piece.p[1]);
        const auto z = static_cast<size_t>(piece.p[2]);
        const float* corner = values + static_cast<size_t>(piece.brick) * 736 + (x * 9 + y) * 9 + z;
        constexpr int offset[4] = {0, 10, 81, 91};
        for (int j = 0; j < 4; ++j) __builtin_prefetch(corner + offset[j]);
    }
}

template <class Lanes>
void integrate_all(const float* values, const BrickPiece* pieces, const uint16_t* order,
                   size_t count, float* integral)
{
    for (size_t i = 0; i < count; i += Lanes::width) {
        const size_t next = i + Lanes::width;
        if (next < count) prefetch_lanes<Lanes>(values, pieces, order + next);
        const auto sum = integrate_lanes<Lanes>(values, pieces, order + i,
                                                [](typename Lanes::Real, typename Lanes::Real) {});
        Lanes::scatter(sum, order + i, integral);
    }
}

template <class Lanes>
void tabulate_all(const float* values, const BrickPiece* pieces, const uint16_t* order,
                  size_t count, CellTable& table)
{
    using Real = typename Lanes::Real;
    for (size_t i = 0; i < count; i += Lanes::width) {
        const size_t next = i + Lanes::width;
        if (next < count) prefetch_lanes<Lanes>(values, pieces, order + next);
        size_t row = 0;
        integrate_lanes<Lanes>(values, pieces, order + i, [&](Real s, Real sum) {
            Lanes::store(table.end[row] + i, s);
            Lanes::store(table.integral[row] + i, Lanes::mul(sum, Lanes::all(0.5f)));
            row = row + 1 < CellTable::most_cells ? row + 1 : row;
        });
    }
}

}  // namespace mote
