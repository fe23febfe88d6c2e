#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "particles/rasterize_splats.h"

namespace mote {

/// One splat as a tile or leaf sees it: position relative to the tile's or leaf's first voxel.
struct TileSplat {
    float x, y, z;
    float support;
    float root_density;
    uint32_t particle;  ///< where the other attributes are
};

/// Splats sorted into buckets, in the order in which they were appended. Each bucket is a chain of
/// blocks: one pass over the splats fills it, without counting first. Blocks are kept for reuse.
class SplatChains {
  public:
    static constexpr uint32_t block_size = 64;

    /// Empties all buckets; from now on there are `bucket_count`.
    void reset(size_t bucket_count)
    {
        buckets_.assign(bucket_count, {});
        used_ = 0;
    }
    [[nodiscard]] size_t bucket_count() const { return buckets_.size(); }
    void add_bucket() { buckets_.push_back({}); }

    /// New last splat of a bucket, to be filled in.
    TileSplat& append(size_t bucket)
    {
        Bucket& b = buckets_[bucket];
        const uint32_t slot = b.count++ % block_size;
        if (slot == 0) append_block(b);
        // The bucket's next lines, or they would come from memory at the next visits (5 % of
        // rasterize() at a million particles).
        __builtin_prefetch(&b.last->splats[std::min(slot + 4, block_size - 1)], 1);
        return b.last->splats[slot];
    }

    [[nodiscard]] size_t count(size_t bucket) const { return buckets_[bucket].count; }

    /// Calls f(span of splats) for each block of a bucket, in order.
    template <class F>
    void for_each_block(size_t bucket, F&& f) const
    {
        uint32_t left = buckets_[bucket].count;
        for (const Block* block = buckets_[bucket].first; left > 0; block = block->next) {
            const uint32_t here = std::min(left, block_size);
            f(std::span<const TileSplat>(block->splats, here));
            left -= here;
        }
    }

  private:
    struct Block {
        TileSplat splats[block_size];
        Block* next;
    };
    struct Bucket {
        uint32_t count = 0;
        Block* first = nullptr;
        Block* last = nullptr;
    };
    void append_block(Bucket& bucket);

    std::vector<Bucket> buckets_;
    std::vector<std::unique_ptr<Block[]>> slabs_;
    size_t used_ = 0;  ///< blocks handed out
};

}  // namespace mote
