#include "volumes/bricks.h"

#include "core/error.h"
#include "volumes/brick_builder.h"

namespace mote {

size_t BrickGrid::memory_bytes() const
{
    return table.size() * sizeof(int32_t) + values.size() * sizeof(float) +
           ranges.size() * sizeof(BrickRange);
}

Vec3 sample_color(const ColorGrid& grid, Vec3 p_object)
{
    const BrickGrid& first = grid.channel[0];
    const Vec3 p = first.index_from_object.point(p_object);
    return {sample_trilinear(first, p), sample_trilinear(grid.channel[1], p),
            sample_trilinear(grid.channel[2], p)};
}

std::shared_ptr<const BrickGrid> make_dense_bricks(Vec3i size, std::span<const float> values,
                                                   const Affine& index_from_object)
{
    MOTE_ASSERT(values.size() == static_cast<size_t>(size.x) * static_cast<size_t>(size.y) *
                                     static_cast<size_t>(size.z));
    const auto value_at = [&](Vec3i p) {
        const bool inside =
            p.x >= 0 && p.y >= 0 && p.z >= 0 && p.x < size.x && p.y < size.y && p.z < size.z;
        if (!inside) return 0.0f;
        return values[(static_cast<size_t>(p.x) * static_cast<size_t>(size.y) +
                       static_cast<size_t>(p.y)) *
                          static_cast<size_t>(size.z) +
                      static_cast<size_t>(p.z)];
    };
    const FillBrick fill = [&](Vec3i origin, float* out) {
        for (int i = 0; i < 729; ++i) out[i] = value_at(origin + Vec3i(i / 81, i / 9 % 9, i % 9));
    };
    BlockTable blocks = BlockTable::covering(Vec3i(0), size - 1, {}, "dense grid");
    float brick[BrickGrid::brick_values];
    for (int z = 0; z < blocks.count.z; ++z) {
        for (int y = 0; y < blocks.count.y; ++y) {
            for (int x = 0; x < blocks.count.x; ++x) {
                fill(blocks.lo + 8 * Vec3i(x, y, z), brick);
                const size_t i = blocks.index(x, y, z);
                blocks.needed[i] = std::any_of(brick, brick + 729, [](float v) { return v > 0; });
                // Only the 8^3 block itself has to be of one value.
                bool is_uniform = true;
                for (int j = 0; j < 729; ++j) {
                    const bool apron = j / 81 == 8 || j / 9 % 9 == 8 || j % 9 == 8;
                    MOTE_ASSERT(brick[j] >= 0.0f && brick[j] < infinity);
                    is_uniform = is_uniform && (apron || brick[j] == brick[0]);
                }
                blocks.uniform[i] = is_uniform ? brick[0] : BlockTable::varied;
            }
        }
    }
    BrickGrid grid = build_bricks(blocks, fill, {}, "dense grid");
    grid.index_from_object = index_from_object;
    for (const float v : values) grid.sum += static_cast<double>(v);
    return std::make_shared<const BrickGrid>(std::move(grid));
}

}  // namespace mote
