#pragma once

#include <array>
#include <span>

#include "particles/kernel_rows.h"
#include "particles/rasterize_tiles.h"

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

/// Adds splats to the sums in order. At most a few dozen at a time, see accumulate_leaf.
template <int Channels>
void accumulate_splats(std::span<const TileSplat> splats, const AttributeComponent* channels,
                       LeafSums<Channels>& sums)
{
    const auto first = [](float v) { return std::max(0, static_cast<int>(std::ceil(v))); };
    const auto last = [](float v) {
        return std::min(leaf_size - 1, static_cast<int>(std::floor(v)));
    };
    for (const TileSplat& s : splats) {
        const KernelRows rows = make_kernel_rows(0.0f, s.z, s.support, s.root_density);
        [[maybe_unused]] std::array<float, static_cast<size_t>(std::max(Channels, 1))> value;
        for (int c = 0; c < Channels; ++c) {
            value[static_cast<size_t>(c)] = channels[c].data[s.particle * channels[c].stride];
        }
        const int x1 = last(s.x + s.support);
        const int y1 = last(s.y + s.support);
        for (int x = first(s.x - s.support); x <= x1; ++x) {
            const float dx2 = sqr(static_cast<float>(x) - s.x);
            for (int y = first(s.y - s.support); y <= y1; ++y) {
                const Float8 w = eval_row(rows, dx2 + sqr(static_cast<float>(y) - s.y));
                const size_t row = static_cast<size_t>(leaf_size * (leaf_size * x + y));
                for (size_t c = 0; c <= Channels; ++c) {
                    add_to(&sums.field[c][row], c == 0 ? w : w * value[c - 1]);
                }
            }
        }
    }
}

/// Sums of any number of splats. Long lists are summed in float by blocks of 64 and the blocks in
/// double: a plain float sum of a million equal splats drifts by percents.
template <int Channels>
void accumulate_leaf(std::span<const TileSplat> splats, const AttributeComponent* channels,
                     LeafSums<Channels>& sums)
{
    constexpr size_t block = 64;
    sums = {};
    if (splats.size() <= block) {
        accumulate_splats<Channels>(splats, channels, sums);
        return;
    }
    std::array<std::array<double, leaf_voxels>, Channels + 1> total{};
    for (size_t i = 0; i < splats.size(); i += block) {
        accumulate_splats<Channels>(splats.subspan(i, std::min(block, splats.size() - i)), channels,
                                    sums);
        for (size_t c = 0; c <= Channels; ++c) {
            for (size_t v = 0; v < leaf_voxels; ++v) {
                total[c][v] += static_cast<double>(sums.field[c][v]);
                sums.field[c][v] = 0.0f;
            }
        }
    }
    for (size_t c = 0; c <= Channels; ++c) {
        for (size_t v = 0; v < leaf_voxels; ++v) {
            sums.field[c][v] = static_cast<float>(total[c][v]);
        }
    }
}

}  // namespace mote
