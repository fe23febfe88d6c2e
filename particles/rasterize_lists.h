#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "particles/rasterize_tiles.h"

namespace mote {

/// Sorts splats of a tile into its leaves (512 buckets, positions relative to the leaf), beginning
/// at `segments[segment][offset]` and stopping once about a million copies are made (24 MB: wide
/// splats touch many leaves). Advances `segment` and `offset`, and returns false when no splats
/// were left.
bool fill_leaf_lists(std::span<const std::span<const TileSplat>> segments, size_t& segment,
                     size_t& offset, SplatChains& lists);

/// Lends SplatChains to tasks, so that their memory is reused. A thread may hold several: while a
/// task waits for its parts, its thread may begin another.
class ChainsPool {
  public:
    [[nodiscard]] std::unique_ptr<SplatChains> take();
    void give_back(std::unique_ptr<SplatChains> chains);

  private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<SplatChains>> idle_;
};

}  // namespace mote
