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

}  // namespace

double kernel_lattice_sum(Vec3 p, float support)
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

void kernel_lattice_sums(const KernelCentres& centres, float* sums)
{
    constexpr float widest_direct = 4.0f;
    const float widest = *std::max_element(centres.support, centres.support + 8);
    if (widest > widest_direct) {
        for (int i = 0; i < 8; ++i) {
            const Vec3 p(centres.x[i], centres.y[i], centres.z[i]);
            sums[i] = static_cast<float>(kernel_lattice_sum(p, centres.support[i]));
        }
        return;
    }
    // Lattice points 1 - reach to reach can lie within a support of `reach` of [0,1).
    const int reach = static_cast<int>(std::ceil(widest));
    const Float8 support = load8(centres.support);
    const Float8 inv_h2 = 1.0f / (support * support);
    const auto falloff = [&](int i, const float* centre) {
        const Float8 d = static_cast<float>(i) - load8(centre);
        return d * d * inv_h2;
    };
    Float8 along_z[2 * static_cast<int>(widest_direct)];
    for (int k = 0; k < 2 * reach; ++k) along_z[k] = falloff(k + 1 - reach, centres.z);
    Float8 sum = {};
    for (int i = 1 - reach; i <= reach; ++i) {
        const Float8 a = 1.0f - falloff(i, centres.x);
        for (int j = 1 - reach; j <= reach; ++j) {
            const Float8 b = a - falloff(j, centres.y);
            Float8 row = {};
            for (int k = 0; k < 2 * reach; ++k) {
                const Float8 root = positive_part(b - along_z[k]);
                row = multiply_add(root, root, row);
            }
            sum += row;
        }
    }
    store8(sums, sum);
}

}  // namespace mote
