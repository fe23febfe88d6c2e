#include "particles/kernel.h"

#include "particles/kernel_rows.h"

namespace mote {
namespace {

/// Lattice range [lo, hi] of a support along one axis.
struct Range {
    Range(float centre, float support)
        : lo(static_cast<int>(std::ceil(centre - support))),
          hi(static_cast<int>(std::floor(centre + support)))
    {
    }
    int lo;
    int hi;
};

/// Supports of at most eight voxels: every row is one vector.
double sum_short_rows(Vec3 p, float support)
{
    const Range x(p.x, support);
    const Range y(p.y, support);
    const float z0 = std::ceil(p.z - support);
    const KernelRows rows = make_kernel_rows(z0, p.z, support, 1.0f);
    Float8 sum = {};
    for (int i = x.lo; i <= x.hi; ++i) {
        const float dx2 = sqr(static_cast<float>(i) - p.x);
        for (int j = y.lo; j <= y.hi; ++j) {
            sum += eval_row(rows, dx2 + sqr(static_cast<float>(j) - p.y));
        }
    }
    return static_cast<double>(((sum[0] + sum[4]) + (sum[1] + sum[5])) +
                               ((sum[2] + sum[6]) + (sum[3] + sum[7])));
}

/// Sum over one row of (a - dz^2/h^2)^2, in closed form: the n lattice points are centred at
/// `d` from the particle, and power sums of centred half-integers are polynomials in n.
double sum_row(double a, double n, double d, double inv_h2)
{
    const double d2 = d * d;
    const double s2 = n * (n * n - 1.0) / 12.0;
    const double s4 = s2 * (3.0 * n * n - 7.0) / 20.0;
    const double moment2 = s2 + n * d2;
    const double moment4 = s4 + 6.0 * d2 * s2 + n * d2 * d2;
    return n * a * a + inv_h2 * (inv_h2 * moment4 - 2.0 * a * moment2);
}

double sum_long_rows(Vec3 p, float support)
{
    const Range x(p.x, support);
    const Range y(p.y, support);
    const double h = static_cast<double>(support);
    const double z = static_cast<double>(p.z);
    const double inv_h2 = 1.0 / (h * h);
    double sum = 0.0;
    for (int i = x.lo; i <= x.hi; ++i) {
        const double dx = i - static_cast<double>(p.x);
        for (int j = y.lo; j <= y.hi; ++j) {
            const double dy = j - static_cast<double>(p.y);
            const double a = 1.0 - (dx * dx + dy * dy) * inv_h2;
            if (a <= 0.0) continue;
            const double reach = h * std::sqrt(a);
            const double lo = std::ceil(z - reach);
            const double hi = std::floor(z + reach);
            if (hi >= lo) sum += sum_row(a, hi - lo + 1.0, 0.5 * (lo + hi) - z, inv_h2);
        }
    }
    return sum;
}

}  // namespace

double kernel_lattice_sum(Vec3 p, float support)
{
    return support <= 3.5f ? sum_short_rows(p, support) : sum_long_rows(p, support);
}

}  // namespace mote
