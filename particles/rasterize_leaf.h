#pragma once

#include <array>
#include <span>

#include "particles/kernel_rows.h"
#include "particles/rasterize_lists.h"

namespace mote {

inline constexpr int leaf_voxels = 512;

/// One component of a particle attribute: value of particle i is data[i * stride].
struct AttributeComponent {
    const float* data;
    size_t stride;
};

/// Sums over one leaf: density, then density times each channel. Voxel order as in OpenVDB: z
/// fastest.
template <int Channels>
struct LeafSums {
    alignas(32) std::array<std::array<float, leaf_voxels>, Channels + 1> field;
};

/// Rows of a leaf that a support meets.
struct RowRange {
    uint32_t x_begin, x_end, y_begin, y_end;
};

[[nodiscard]] inline RowRange row_range(const TileSplat& s)
{
    const auto first = [](float v) {
        return static_cast<uint32_t>(std::max(0, static_cast<int>(std::ceil(v))));
    };
    const auto end = [](float v) {
        return static_cast<uint32_t>(std::min(leaf_size, static_cast<int>(std::floor(v)) + 1));
    };
    return {first(s.x - s.support), end(s.x + s.support), first(s.y - s.support),
            end(s.y + s.support)};
}

/// Adds splats to the sums in order; SplatChains::block_size at the most, see accumulate_leaf.
template <int Channels>
void accumulate_splats(std::span<const TileSplat> splats, const AttributeComponent* channels,
                       LeafSums<Channels>& sums)
{
    // Ranges of rows first: where the processor guesses the length of a loop wrongly, it finds out
    // at once (2 % of rasterize() at a million particles).
    std::array<RowRange, SplatChains::block_size> ranges;
    for (size_t i = 0; i < splats.size(); ++i) ranges[i] = row_range(splats[i]);
    for (size_t i = 0; i < splats.size(); ++i) {
        const TileSplat& s = splats[i];
        const RowRange range = ranges[i];
        const KernelBlock kernel = make_kernel_block(s.x, s.y, s.z, s.support, s.root_density);
        [[maybe_unused]] std::array<float, static_cast<size_t>(std::max(Channels, 1))> value;
        for (size_t c = 0; c < Channels; ++c) {
            value[c] = channels[c].data[s.particle * channels[c].stride];
        }
        for (size_t x = range.x_begin; x < range.x_end; ++x) {
            for (size_t y = range.y_begin; y < range.y_end; ++y) {
                const Float8 root = eval_row_roots(kernel, x, y);
                const size_t row = leaf_size * (leaf_size * x + y);
                float* const density = &sums.field[0][row];
                store8(density, multiply_add(root, root, load8(density)));
                for (size_t c = 1; c <= Channels; ++c) {
                    float* const sum = &sums.field[c][row];
                    store8(sum, load8(sum) + root * root * value[c - 1]);
                }
            }
        }
    }
}

/// Sums of one leaf's list. Long lists are summed in float by blocks and the blocks in double: a
/// plain float sum of a million equal splats drifts by percents.
template <int Channels>
void accumulate_leaf(const SplatChains& lists, size_t leaf, const AttributeComponent* channels,
                     LeafSums<Channels>& sums)
{
    sums = {};
    if (lists.count(leaf) <= SplatChains::block_size) {
        lists.for_each_block(leaf, [&](std::span<const TileSplat> splats) {
            accumulate_splats<Channels>(splats, channels, sums);
        });
        return;
    }
    std::array<std::array<double, leaf_voxels>, Channels + 1> total{};
    lists.for_each_block(leaf, [&](std::span<const TileSplat> splats) {
        accumulate_splats<Channels>(splats, channels, sums);
        for (size_t c = 0; c <= Channels; ++c) {
            for (size_t v = 0; v < leaf_voxels; ++v) {
                total[c][v] += static_cast<double>(sums.field[c][v]);
                sums.field[c][v] = 0.0f;
            }
        }
    });
    for (size_t c = 0; c <= Channels; ++c) {
        for (size_t v = 0; v < leaf_voxels; ++v) {
            sums.field[c][v] = static_cast<float>(total[c][v]);
        }
    }
}

}  // namespace mote
