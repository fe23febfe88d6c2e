#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "volumes/emission.h"

namespace mote {
namespace {

constexpr int density_part = 0;
constexpr int emission_part = 1;

/// Object-space box -> largest value of a grid that may meet it.
float max_over(const BrickGrid& grid, const Affine& object_from_brick_local, Vec3 corner)
{
    Bounds3 box;
    for (int n = 0; n < 8; ++n) {
        // A hair inside, so that aligned grids look at one brick and not at 27.
        const Vec3 inside(n & 1 ? 7.99f : 0.01f, n & 2 ? 7.99f : 0.01f, n & 4 ? 7.99f : 0.01f);
        const Vec3 p_object = object_from_brick_local.point(corner + inside);
        box.extend(grid.index_from_object.point(p_object) - Vec3(grid.lo));
    }
    Vec3i lo;
    Vec3i hi;
    for (int axis = 0; axis < 3; ++axis) {
        const float last = static_cast<float>(grid.brick_count[axis] - 1);
        lo[axis] = static_cast<int>(std::clamp(std::floor(box.lo[axis] / 8.0f), 0.0f, last));
        hi[axis] = static_cast<int>(std::clamp(std::floor(box.hi[axis] / 8.0f), 0.0f, last));
    }
    float max = 0.0f;
    for (int z = lo.z; z <= hi.z; ++z) {
        for (int y = lo.y; y <= hi.y; ++y) {
            for (int x = lo.x; x <= hi.x; ++x) {
                const int32_t brick = std::max(grid.table[grid.table_index(x, y, z)], 0);
                max = std::max(max, grid.ranges[static_cast<size_t>(brick)].max);
            }
        }
    }
    return max;
}

Affine object_from_local_of(const BrickGrid& grid)
{
    const Mat3 linear = glm::inverse(grid.index_from_object.linear);
    return {linear, linear * (Vec3(grid.lo) - grid.index_from_object.offset)};
}

/// Bound of the luminance of this part's term of j in a brick.
float bound(const Volume& volume, int part, const BrickRange& range, const Affine& to_object,
            Vec3 corner)
{
    const Emission& e = volume.emission_params;
    if (part == emission_part) {
        return e.emission_scale * range.max * luminance(e.emission_color);
    }
    float T = e.temperature_offset;
    if (volume.temperature && !volume.temperature->index_bounds.is_empty()) {
        const float hottest = max_over(*volume.temperature, to_object, corner);
        T += std::max(0.0f, e.temperature_scale * hottest);
    }
    if (!(T > 0.0f)) return 0.0f;
    return 1.0001f * e.blackbody_scale * volume.density_scale * range.max * sqr(sqr(T / 1500.0f));
}

/// Mean luminance of j over a brick, from 4^3 midpoints; exact for the emission grid's term.
float mean_luminance(const Volume& volume, int part, const BrickRange& range,
                     const Affine& to_object, Vec3 corner)
{
    const Emission& e = volume.emission_params;
    if (part == emission_part) return e.emission_scale * range.mean * luminance(e.emission_color);
    Volume glow_only = {};
    glow_only.density = volume.density;
    glow_only.temperature = volume.temperature;
    glow_only.density_scale = volume.density_scale;
    glow_only.emission_params = e;
    glow_only.emission_params.emission_scale = 0.0f;
    float sum = 0.0f;
    for (int n = 0; n < 64; ++n) {
        const Vec3 p(static_cast<float>(2 * (n & 3) + 1), static_cast<float>(2 * (n >> 2 & 3) + 1),
                     static_cast<float>(2 * (n >> 4) + 1));
        sum += luminance(emission_at(glow_only, to_object.point(corner + p)));
    }
    return sum / 64.0f;
}

void add_part(const Volume& volume, int part, const BrickGrid* grid, EmissiveBricks& out)
{
    if (!grid || grid->index_bounds.is_empty()) return;
    const Affine to_object = object_from_local_of(*grid);
    const double brick_volume = 512.0 * std::abs(glm::determinant(glm::dmat3(to_object.linear)));
    out.parts[part].grid = grid;
    out.parts[part].brick_volume = brick_volume;
    out.parts[part].pmf.assign(grid->table.size(), 0.0f);
    const size_t first = out.bricks.size();
    for (int z = 0; z < grid->brick_count.z; ++z) {
        for (int y = 0; y < grid->brick_count.y; ++y) {
            for (int x = 0; x < grid->brick_count.x; ++x) {
                if (grid->table[grid->table_index(x, y, z)] <= 0) continue;
                EmissiveBricks::Brick brick;
                brick.part = part;
                brick.position = {x, y, z};
                out.bricks.push_back(brick);
            }
        }
    }
    parallel_for(out.bricks.size() - first, 64, [&](size_t begin, size_t end) {
        for (size_t i = first + begin; i != first + end; ++i) {
            EmissiveBricks::Brick& brick = out.bricks[i];
            const Vec3i c = brick.position;
            const int32_t number = grid->table[grid->table_index(c.x, c.y, c.z)];
            const BrickRange& range = grid->ranges[static_cast<size_t>(number)];
            const Vec3 corner = Vec3(c) * 8.0f;
            brick.majorant = bound(volume, part, range, to_object, corner);
            // The midpoints may miss a hot spot: a share of the bound keeps it reachable.
            const float mean = mean_luminance(volume, part, range, to_object, corner);
            const double density = static_cast<double>(std::max(mean, 0.01f * brick.majorant));
            brick.power = static_cast<float>(density * brick_volume) * 4.0f * pi;
        }
    });
}

double world_scale(const Volume& volume, float time)
{
    return std::abs(glm::determinant(glm::dmat3(matrix(volume.world_from_object.at(time)))));
}

}  // namespace

EmissiveBricks make_emissive_bricks(const Volume& volume)
{
    EmissiveBricks out;
    const Emission& e = volume.emission_params;
    if (e.blackbody_scale > 0.0f && volume.density_scale > 0.0f) {
        add_part(volume, density_part, volume.density.get(), out);
    }
    if (e.emission_scale > 0.0f) add_part(volume, emission_part, volume.emission.get(), out);
    const auto dark = [](const EmissiveBricks::Brick& brick) { return !(brick.power > 0.0f); };
    out.bricks.erase(std::remove_if(out.bricks.begin(), out.bricks.end(), dark), out.bricks.end());
    for (const EmissiveBricks::Brick& brick : out.bricks) {
        out.total_power += static_cast<double>(brick.power);
    }
    double sum = 0.0;
    for (const EmissiveBricks::Brick& brick : out.bricks) {
        EmissiveBricks::Part& part = out.parts[brick.part];
        const Vec3i c = brick.position;
        // The pmf is what the search in the float cdf really does.
        const float before = out.cdf.empty() ? 0.0f : out.cdf.back();
        sum += static_cast<double>(brick.power);
        out.cdf.push_back(static_cast<float>(std::min(1.0, sum / out.total_power)));
        if (&brick == &out.bricks.back()) out.cdf.back() = 1.0f;
        part.pmf[part.grid->table_index(c.x, c.y, c.z)] = out.cdf.back() - before;
    }
    return out;
}

EmissionSample sample_emission(const Volume& volume, const EmissiveBricks& bricks, float time,
                               Rng& rng)
{
    const float u = rng.uniform();
    const auto chosen = std::upper_bound(bricks.cdf.begin(), bricks.cdf.end(), u);
    const size_t i =
        std::min(static_cast<size_t>(chosen - bricks.cdf.begin()), bricks.bricks.size() - 1);
    const EmissiveBricks::Brick& brick = bricks.bricks[i];
    const BrickGrid& grid = *bricks.parts[brick.part].grid;
    const Vec3 local = 8.0f * (Vec3(brick.position) + rng.uniform3());
    const Vec3 p_object = object_from_local_of(grid).point(local);
    EmissionSample out;
    out.p = Vec3(matrix(volume.world_from_object.at(time)) * glm::dvec4(Vec3d(p_object), 1.0));
    out.j = emission_at(volume, p_object);
    out.pdf_volume = emission_pdf(volume, bricks, time, p_object);
    if (!(out.pdf_volume > 0.0f)) out.j = Spectrum(0.0f);  // rounded across a brick's border
    return out;
}

float emission_pdf(const Volume& volume, const EmissiveBricks& bricks, float time, Vec3 p_object)
{
    double pdf = 0.0;
    for (const EmissiveBricks::Part& part : bricks.parts) {
        if (!part.grid) continue;
        const BrickGrid& grid = *part.grid;
        const Vec3 p = (grid.index_from_object.point(p_object) - Vec3(grid.lo)) / 8.0f;
        const Vec3 count(grid.brick_count);
        const bool inside = p.x >= 0.0f && p.y >= 0.0f && p.z >= 0.0f && p.x < count.x &&
                            p.y < count.y && p.z < count.z;
        if (!inside) continue;
        const Vec3i c(p);
        pdf += static_cast<double>(part.pmf[grid.table_index(c.x, c.y, c.z)]) / part.brick_volume;
    }
    return static_cast<float>(pdf / world_scale(volume, time));
}

}  // namespace mote
