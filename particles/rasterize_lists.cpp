#include "particles/rasterize_lists.h"

namespace mote {

bool fill_leaf_lists(std::span<const std::span<const TileSplat>> segments, size_t& segment,
                     size_t& offset, SplatChains& lists)
{
    constexpr size_t max_copies = 1'000'000;
    lists.reset(tile_leaves);
    size_t copies = 0;
    // Boxes first, some splats ahead: every third time the processor guesses the number of leaves
    // wrongly, and then finds out at once (7 % of rasterize() at a million particles).
    constexpr size_t ahead = 16;
    LeafBox boxes[ahead];
    for (; segment < segments.size(); ++segment, offset = 0) {
        const std::span<const TileSplat> splats = segments[segment];
        while (offset < splats.size()) {
            const size_t count = std::min(ahead, splats.size() - offset);
            for (size_t i = 0; i < count; ++i) boxes[i] = leaf_box(splats[offset + i]);
            for (size_t i = 0; i < count; ++i, ++offset) {
                if (copies >= max_copies) return true;
                const TileSplat& splat = splats[offset];
                for_each_leaf(splat, boxes[i], [&](int k) {
                    lists.append(static_cast<size_t>(k)) = {
                        splat.x - static_cast<float>(leaf_size * (k >> 6)),
                        splat.y - static_cast<float>(leaf_size * (k >> 3 & 7)),
                        splat.z - static_cast<float>(leaf_size * (k & 7)),
                        splat.support,
                        splat.root_density,
                        splat.particle};
                    ++copies;
                });
            }
        }
    }
    return copies > 0;
}

std::unique_ptr<SplatChains> ChainsPool::take()
{
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return std::make_unique<SplatChains>();
    std::unique_ptr<SplatChains> chains = std::move(idle_.back());
    idle_.pop_back();
    return chains;
}

void ChainsPool::give_back(std::unique_ptr<SplatChains> chains)
{
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(chains));
}

}  // namespace mote
