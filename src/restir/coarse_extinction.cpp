#include "restir/coarse_extinction.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace mote {
namespace {

constexpr int most_levels = 8;

/// Mean extinction of one volume over a cell.
float mean_sigma_t(const Volume& volume, const GridFrame& frame, Vec3 lo, float cell, int n)
{
    float sum = 0.0f;
    for (int z = 0; z < n; ++z) {
        for (int y = 0; y < n; ++y) {
            for (int x = 0; x < n; ++x) {
                const Vec3 u = (Vec3(x, y, z) + 0.5f) / static_cast<float>(n);
                sum += sample_local(*volume.density, Vec3(frame.point(lo + cell * u)));
            }
        }
    }
    return volume.density_scale * sum / static_cast<float>(n * n * n);
}

void add_volume(const Volume& volume, const SmokeCells& cells, CoarseExtinction::Level& level)
{
    if (!volume.density || !(volume.density_scale > 0.0f)) return;
    const Lattice& lattice = cells.lattice;
    const GridFrame frame = frames_at(volume, 0.5f).density;
    const double voxels =
        static_cast<double>(lattice.cell) * std::cbrt(std::abs(glm::determinant(frame.linear)));
    const int n = voxels > 6.0 ? 3 : 2;
    parallel_for(lattice.size(), 4096, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            if (cells.marks[i] != SmokeCells::Smoke) continue;
            const Vec3 lo = lattice.lo + lattice.cell * Vec3(lattice.coordinates(i));
            level.sigma_t[i] += mean_sigma_t(volume, frame, lo, lattice.cell, n);
        }
    });
}

CoarseExtinction::Level halved(const CoarseExtinction::Level& fine)
{
    CoarseExtinction::Level out;
    out.count = (fine.count + 1) / 2;
    const auto nx = static_cast<size_t>(out.count.x);
    const auto ny = static_cast<size_t>(out.count.y);
    out.sigma_t.assign(nx * ny * static_cast<size_t>(out.count.z), 0.0f);
    size_t i = 0;
    for (int z = 0; z < fine.count.z; ++z) {
        for (int y = 0; y < fine.count.y; ++y) {
            const size_t row = (static_cast<size_t>(z / 2) * ny + static_cast<size_t>(y / 2)) * nx;
            for (int x = 0; x < fine.count.x; ++x)
                out.sigma_t[row + static_cast<size_t>(x / 2)] += 0.125f * fine.sigma_t[i++];
        }
    }
    return out;
}

}  // namespace

CoarseExtinction make_coarse_extinction(const Media& media, const SmokeCells& cells)
{
    CoarseExtinction out;
    out.lattice = cells.lattice;
    CoarseExtinction::Level finest;
    finest.count = cells.lattice.count;
    finest.sigma_t.assign(cells.lattice.size(), 0.0f);
    for (const Volume& volume : media.volumes) add_volume(volume, cells, finest);
    out.levels.push_back(std::move(finest));
    while (static_cast<int>(out.levels.size()) < most_levels) {
        const Vec3i count = out.levels.back().count;
        if (std::max(count.x, std::max(count.y, count.z)) <= 2) break;
        out.levels.push_back(halved(out.levels.back()));
    }
    return out;
}

float coarse_optical_depth(const CoarseExtinction& extinction, Vec3 from, Vec3 to, int most_steps)
{
    const Lattice& lattice = extinction.lattice;
    const Vec3 a = lattice.to_lattice(from);
    const Vec3 d = lattice.to_lattice(to) - a;
    const Bounds3 box{Vec3(0.0f), Vec3(lattice.count)};
    const Interval inside = clip(a, d, box, {0.0f, 1.0f});
    const float length = glm::length((inside.t1 - inside.t0) * d);  // in cells
    if (!(length > 0.0f)) return 0.0f;
    size_t level = 0;
    float size = 1.0f;
    while (length > size * static_cast<float>(most_steps) && level + 1 < extinction.levels.size()) {
        ++level;
        size *= 2.0f;
    }
    const CoarseExtinction::Level& data = extinction.levels[level];
    const int steps = std::clamp(static_cast<int>(std::ceil(length / size)), 1, most_steps);
    const float inv_size = 1.0f / size;
    const float dt = (inside.t1 - inside.t0) / static_cast<float>(steps);
    const Vec3 step = dt * inv_size * d;
    Vec3 p = inv_size * (a + (inside.t0 + 0.5f * dt) * d);
    const auto row = static_cast<size_t>(data.count.x);
    const size_t slice = row * static_cast<size_t>(data.count.y);
    float sum = 0.0f;
    for (int i = 0; i < steps; ++i) {
        // Midpoints lie inside the box, whose cells all levels cover.
        sum += data.sigma_t[static_cast<size_t>(static_cast<int>(p.z)) * slice +
                            static_cast<size_t>(static_cast<int>(p.y)) * row +
                            static_cast<size_t>(static_cast<int>(p.x))];
        p += step;
    }
    return sum * lattice.cell * length / static_cast<float>(steps);
}

}  // namespace mote
