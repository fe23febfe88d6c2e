#include "restir/coarse_extinction.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace mote {
namespace {

/// Where a cell is looked at: n^3 points, as offsets from its low corner in a volume's local space.
std::vector<Vec3> lookup_offsets(const GridFrame& frame, float cell)
{
    const double voxels =
        static_cast<double>(cell) * std::cbrt(std::abs(glm::determinant(frame.linear)));
    const int n = voxels > 6.0 ? 3 : 2;
    std::vector<Vec3> out;
    for (int i = 0; i < n * n * n; ++i) {
        const Vec3 u = (Vec3(i % n, i / n % n, i / (n * n)) + 0.5f) / static_cast<float>(n);
        out.push_back(Vec3(frame.vector(cell * u)));
    }
    return out;
}

void add_volume(const Volume& volume, const SmokeCells& cells, std::vector<float>& sigma_t)
{
    if (!volume.density || !(volume.density_scale > 0.0f)) return;
    const Lattice& lattice = cells.lattice;
    const GridFrame frame = frames_at(volume, 0.5f).density;
    const std::vector<Vec3> offsets = lookup_offsets(frame, lattice.cell);
    const float scale = volume.density_scale / static_cast<float>(offsets.size());
    parallel_for(lattice.size(), 4096, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            if (cells.marks[i] != SmokeCells::Smoke) continue;
            const Vec3 corner = lattice.lo + lattice.cell * Vec3(lattice.coordinates(i));
            const Vec3 p(frame.point(corner));
            float sum = 0.0f;
            for (const Vec3& offset : offsets) sum += sample_local(*volume.density, p + offset);
            sigma_t[i] += scale * sum;
        }
    });
}

/// Appends the level above the last one, its cells the means of 2^3 (0 outside the lattice).
void add_halved_level(Vec3i fine_count, CoarseExtinction& out)
{
    const Vec3i count = (fine_count + 1) / 2;
    const auto nx = static_cast<size_t>(count.x);
    const auto ny = static_cast<size_t>(count.y);
    auto i = static_cast<size_t>(out.first[out.level_count - 1]);
    const size_t first = out.sigma_t.size();
    out.sigma_t.resize(first + nx * ny * static_cast<size_t>(count.z), 0.0f);
    for (int z = 0; z < fine_count.z; ++z) {
        for (int y = 0; y < fine_count.y; ++y) {
            float* row = out.sigma_t.data() + first +
                         (static_cast<size_t>(z / 2) * ny + static_cast<size_t>(y / 2)) * nx;
            for (int x = 0; x < fine_count.x; ++x) row[x / 2] += 0.125f * out.sigma_t[i++];
        }
    }
    out.first[out.level_count] = static_cast<int32_t>(first);
    out.row[out.level_count] = count.x;
    out.slice[out.level_count] = count.x * count.y;
    ++out.level_count;
}

/// A step towards each point in one coordinate, in cells; finite for any input.
[[gnu::always_inline]] inline Float8 offset(const Float8& to, float lo, float inv_cell, float from)
{
    constexpr float most = 1e15f;  // also what NaN becomes
    const Float8 d = (to - lo) * inv_cell - from;
    return abs(d) < most ? d : splat(most);
}

/// Fraction of the way after which one coordinate leaves (0, hi).
[[gnu::always_inline]] inline Float8 exit_fraction(const Float8& d, float from, float hi)
{
    return (d > 0.0f ? splat(hi - from) : splat(from)) / abs(d);
}

}  // namespace

CoarseExtinction make_coarse_extinction(const Media& media, const SmokeCells& cells)
{
    CoarseExtinction out;
    out.lattice = cells.lattice;
    out.sigma_t.assign(cells.lattice.size(), 0.0f);
    for (const Volume& volume : media.volumes) add_volume(volume, cells, out.sigma_t);
    Vec3i count = cells.lattice.count;
    out.row[0] = count.x;
    out.slice[0] = count.x * count.y;
    out.level_count = 1;
    while (out.level_count < CoarseExtinction::most_levels &&
           std::max(count.x, std::max(count.y, count.z)) > 2) {
        add_halved_level(count, out);
        count = (count + 1) / 2;
    }
    return out;
}

void coarse_optical_depths(const CoarseExtinction& extinction, Vec3 from, const Float8& x,
                           const Float8& y, const Float8& z, int steps, Float8& tau)
{
    const Lattice& lattice = extinction.lattice;
    // A hair inside, so that rounding cannot put a lookup outside.
    const Vec3 hi = Vec3(lattice.count) - 0.01f;
    const Vec3 a = glm::clamp(lattice.to_lattice(from), Vec3(0.01f), hi);
    const float inv_cell = 1.0f / lattice.cell;
    const float inv_steps = 1.0f / static_cast<float>(steps);
    Float8 dx = offset(x, lattice.lo.x, inv_cell, a.x);
    Float8 dy = offset(y, lattice.lo.y, inv_cell, a.y);
    Float8 dz = offset(z, lattice.lo.z, inv_cell, a.z);
    const Float8 inside = min(min(exit_fraction(dx, a.x, hi.x), exit_fraction(dy, a.y, hi.y)),
                              min(exit_fraction(dz, a.z, hi.z), splat(1.0f)));
    dx *= inside * inv_steps;
    dy *= inside * inv_steps;
    dz *= inside * inv_steps;
    const Float8 step2 = dx * dx + dy * dy + dz * dz;
    const Float8 step = step2 * approximate_inv_sqrt(step2);  // in cells
    // Smallest level with step <= 2^level.
    Int8 level = ((bits(step) - 1) >> 23) - 126;
    const int32_t top = extinction.level_count - 1;
    level = level > 0 ? level : Int8{};
    level = level < top ? level : Int8{} + top;
    const Float8 inv_size = from_bits((127 - level) << 23);
    dx *= inv_size;
    dy *= inv_size;
    dz *= inv_size;
    Float8 px = a.x * inv_size + 0.5f * dx;
    Float8 py = a.y * inv_size + 0.5f * dy;
    Float8 pz = a.z * inv_size + 0.5f * dz;
    Int8 first;
    Int8 row;
    Int8 slice;
    for (int l = 0; l < lane_count; ++l) {
        first[l] = extinction.first[level[l]];
        row[l] = extinction.row[level[l]];
        slice[l] = extinction.slice[level[l]];
    }
    const float* sigma_t = extinction.sigma_t.data();
    Float8 sum{};
    for (int i = 0; i < steps; ++i) {
        const Int8 cell = first + __builtin_convertvector(pz, Int8) * slice +
                          __builtin_convertvector(py, Int8) * row +
                          __builtin_convertvector(px, Int8);
        sum += Float8{sigma_t[cell[0]], sigma_t[cell[1]], sigma_t[cell[2]], sigma_t[cell[3]],
                      sigma_t[cell[4]], sigma_t[cell[5]], sigma_t[cell[6]], sigma_t[cell[7]]};
        px += dx;
        py += dy;
        pz += dz;
    }
    tau = sum * step * lattice.cell;
}

}  // namespace mote
