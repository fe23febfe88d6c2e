#include "restir/coarse_media.h"

#include "volumes/brick_builder.h"
#include "volumes/media_extent.h"

namespace mote {
namespace {

constexpr int fine_edge = 19;  ///< fine voxels that 9 coarse ones are made from
constexpr int coarse_edge = BrickGrid::brick_stride;

int floor_div(int a, int b)
{
    return a >= 0 ? a / b : -((-a + b - 1) / b);
}

/// The brick with the 8^3 voxels from index coordinate `origin`, or brick 0, which is all zeros.
int brick_at(const BrickGrid& grid, Vec3i origin)
{
    const Vec3i p = origin - grid.lo;
    const Vec3i position(floor_div(p.x, 8), floor_div(p.y, 8), floor_div(p.z, 8));
    for (int axis = 0; axis < 3; ++axis) {
        if (position[axis] < 0 || position[axis] >= grid.brick_count[axis]) return 0;
    }
    return std::max(grid.table[grid.table_index(position.x, position.y, position.z)], 0);
}

/// Voxels `first` .. first + 18 along each axis, z fastest.
void gather(const BrickGrid& grid, Vec3i first, float* out)
{
    std::fill_n(out, fine_edge * fine_edge * fine_edge, 0.0f);
    const Vec3i last = first + (fine_edge - 1);
    for (int bx = floor_div(first.x, 8) * 8; bx <= last.x; bx += 8) {
        for (int by = floor_div(first.y, 8) * 8; by <= last.y; by += 8) {
            for (int bz = floor_div(first.z, 8) * 8; bz <= last.z; bz += 8) {
                const int brick = brick_at(grid, {bx, by, bz});
                if (brick == 0) continue;
                const int z0 = std::max(bz, first.z);
                const int count = std::min(bz + 7, last.z) - z0 + 1;
                for (int x = std::max(bx, first.x); x <= std::min(bx + 7, last.x); ++x) {
                    for (int y = std::max(by, first.y); y <= std::min(by + 7, last.y); ++y) {
                        const ptrdiff_t row = (x - first.x) * fine_edge + (y - first.y);
                        std::copy_n(grid.corner(brick, x - bx, y - by, z0 - bz), count,
                                    out + row * fine_edge + (z0 - first.z));
                    }
                }
            }
        }
    }
}

/// Halves the middle axis of [outer][19][inner] to [outer][9][inner].
void halve_axis(const float* in, int outer, int inner, float* out)
{
    for (int o = 0; o < outer; ++o) {
        for (int c = 0; c < coarse_edge; ++c) {
            const float* row = in + ptrdiff_t{o * fine_edge + 2 * c} * inner;
            for (int i = 0; i < inner; ++i) {
                *out++ = 0.25f * (row[i] + row[i + 2 * inner]) + 0.5f * row[i + inner];
            }
        }
    }
}

bool is_any_active(const BrickGrid& grid, Vec3i lo, Vec3i hi)
{
    for (int x = floor_div(lo.x, 8) * 8; x <= hi.x; x += 8) {
        for (int y = floor_div(lo.y, 8) * 8; y <= hi.y; y += 8) {
            for (int z = floor_div(lo.z, 8) * 8; z <= hi.z; z += 8) {
                if (brick_at(grid, {x, y, z}) != 0) return true;
            }
        }
    }
    return false;
}

}  // namespace

BrickGrid halve_bricks(const BrickGrid& grid)
{
    if (grid.index_bounds.is_empty()) return grid;
    // A coarse voxel I sits on the fine one 2 I and sees those beside it.
    const Vec3i fine_last = grid.lo + grid.brick_count * BrickGrid::brick_size;
    const Vec3i lo(floor_div(grid.lo.x - 1, 2), floor_div(grid.lo.y - 1, 2),
                   floor_div(grid.lo.z - 1, 2));
    const Vec3i hi(floor_div(fine_last.x + 2, 2), floor_div(fine_last.y + 2, 2),
                   floor_div(fine_last.z + 2, 2));
    BlockTable blocks = BlockTable::covering(lo, hi, {}, "coarse grid");
    std::fill(blocks.uniform.begin(), blocks.uniform.end(), BlockTable::varied);
    for (int z = 0; z < blocks.count.z; ++z) {
        for (int y = 0; y < blocks.count.y; ++y) {
            for (int x = 0; x < blocks.count.x; ++x) {
                const Vec3i first = 2 * (blocks.lo + 8 * Vec3i(x, y, z)) - 1;
                blocks.needed[blocks.index(x, y, z)] =
                    is_any_active(grid, first, first + (fine_edge - 1)) ? 1 : 0;
            }
        }
    }
    const FillBrick fill = [&grid](Vec3i origin, float* values) {
        constexpr int f = fine_edge;
        constexpr int c = coarse_edge;
        float a[f * f * f];
        float b[f * f * c];
        gather(grid, 2 * origin - 1, a);
        halve_axis(a, f * f, 1, b);
        halve_axis(b, f, c, a);
        halve_axis(a, 1, c * c, values);
    };
    BrickGrid out = build_bricks(blocks, fill, {}, "coarse grid");
    // Bricks are marked generously; what is not empty lies within two voxels of what was not.
    out.index_bounds.lo = glm::max(out.index_bounds.lo, 0.5f * grid.index_bounds.lo - 2.0f);
    out.index_bounds.hi = glm::min(out.index_bounds.hi, 0.5f * grid.index_bounds.hi + 2.0f);
    out.index_from_object = {0.5f * grid.index_from_object.linear,
                             0.5f * grid.index_from_object.offset};
    out.sum = grid.sum / 8.0;
    return out;
}

Media coarse_media(const Media& media, float voxel_size)
{
    Media out;
    for (const Volume& volume : media.volumes) {
        if (is_void(volume)) continue;
        Volume coarse;
        coarse.name = volume.name;
        coarse.density = volume.density;
        coarse.density_scale = volume.density_scale;
        coarse.world_from_object = volume.world_from_object;
        finalize(coarse);
        for (int halvings = 0; halvings < 16; ++halvings) {
            const Mat4d m = world_from_local(coarse, cache_time);
            double edge = 0.0;
            for (int axis = 0; axis < 3; ++axis) edge = std::max(edge, glm::length(Vec3d(m[axis])));
            if (!(edge > 0.0 && 2.0 * edge < 1.01 * static_cast<double>(voxel_size))) break;
            coarse.density = std::make_shared<const BrickGrid>(halve_bricks(*coarse.density));
            finalize(coarse);
        }
        out.volumes.push_back(std::move(coarse));
    }
    return out;
}

}  // namespace mote
