#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "particles/rasterize_tiles.h"

namespace mote {

/// Splats of one tile by leaf, in particle order, positions relative to the leaf. Each leaf has a
/// chain of blocks, filled in one pass over the splats (no counting pass). Reused between tiles.
class LeafLists {
  public:
    /// Long sums are taken block by block in float, and over blocks in double.
    static constexpr size_t block_size = 64;

    /// Sorts splats into leaves, beginning at `segments[segment][offset]` and stopping once about
    /// a million copies are made (24 MB: wide splats touch many leaves). Advances `segment` and
    /// `offset`, and returns false when no splats were left.
    bool fill(std::span<const std::span<const TileSplat>> segments, size_t& segment,
              size_t& offset);

    [[nodiscard]] size_t count(int leaf) const { return bucket(leaf).count; }

    /// Calls f(span of splats) for each block of a leaf.
    template <class F>
    void for_each_block(int leaf, F&& f) const
    {
        const Bucket& b = bucket(leaf);
        uint32_t block = b.first;
        for (size_t left = b.count; left > 0; block = blocks_[block]->next) {
            const size_t here = std::min(left, block_size);
            f(std::span<const TileSplat>(blocks_[block]->splats, here));
            left -= here;
        }
    }

  private:
    struct Block {
        TileSplat splats[block_size];
        uint32_t next;
    };
    struct Bucket {
        uint32_t count = 0;
        uint32_t first = 0;
        Block* last = nullptr;
    };

    [[nodiscard]] const Bucket& bucket(int leaf) const
    {
        return buckets_[static_cast<size_t>(leaf)];
    }
    void append_block(Bucket& bucket);

    std::array<Bucket, tile_leaves> buckets_;
    std::vector<std::unique_ptr<Block[]>> slabs_;
    std::vector<Block*> blocks_;
    uint32_t used_ = 0;
};

/// Lends LeafLists to tasks. A thread may hold several, as waiting tasks run others in between.
class LeafListsPool {
  public:
    [[nodiscard]] std::unique_ptr<LeafLists> take();
    void give_back(std::unique_ptr<LeafLists> lists);

  private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<LeafLists>> idle_;
};

}  // namespace mote
