#include "particles/rasterize_chains.h"

namespace mote {

void SplatChains::append_block(Bucket& bucket)
{
    constexpr size_t blocks_per_slab = 64;  // 100 kB
    if (used_ == blocks_per_slab * slabs_.size()) {
        slabs_.push_back(std::make_unique_for_overwrite<Block[]>(blocks_per_slab));
    }
    Block* const block = &slabs_[used_ / blocks_per_slab][used_ % blocks_per_slab];
    ++used_;
    (bucket.last ? bucket.last->next : bucket.first) = block;
    bucket.last = block;
}

}  // namespace mote
