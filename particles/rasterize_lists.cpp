#include "particles/rasterize_lists.h"

namespace mote {
namespace {

constexpr size_t max_copies = 1'000'000;
constexpr size_t blocks_per_slab = 256;

}  // namespace

void LeafLists::append_block(Bucket& bucket)
{
    if (used_ == blocks_.size()) {
        slabs_.push_back(std::make_unique_for_overwrite<Block[]>(blocks_per_slab));
        for (size_t i = 0; i < blocks_per_slab; ++i) blocks_.push_back(&slabs_.back()[i]);
    }
    (bucket.last ? bucket.last->next : bucket.first) = used_;
    bucket.last = blocks_[used_++];
}

bool LeafLists::fill(std::span<const std::span<const TileSplat>> segments, size_t& segment,
                     size_t& offset)
{
    buckets_.fill({});
    used_ = 0;
    size_t copies = 0;
    for (; segment < segments.size() && copies < max_copies; ++segment, offset = 0) {
        for (; offset < segments[segment].size(); ++offset) {
            if (copies >= max_copies) return true;
            const TileSplat& splat = segments[segment][offset];
            for_each_leaf(splat, leaf_box(splat), [&](int k) {
                Bucket& bucket = buckets_[static_cast<size_t>(k)];
                const size_t slot = bucket.count++ % block_size;
                if (slot == 0) append_block(bucket);
                TileSplat& copy = bucket.last->splats[slot];
                copy.x = splat.x - static_cast<float>(leaf_size * (k >> 6));
                copy.y = splat.y - static_cast<float>(leaf_size * (k >> 3 & 7));
                copy.z = splat.z - static_cast<float>(leaf_size * (k & 7));
                copy.support = splat.support;
                copy.root_density = splat.root_density;
                copy.particle = splat.particle;
                ++copies;
            });
        }
    }
    return copies > 0;
}

std::unique_ptr<LeafLists> LeafListsPool::take()
{
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return std::make_unique<LeafLists>();
    std::unique_ptr<LeafLists> lists = std::move(idle_.back());
    idle_.pop_back();
    return lists;
}

void LeafListsPool::give_back(std::unique_ptr<LeafLists> lists)
{
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(lists));
}

}  // namespace mote
