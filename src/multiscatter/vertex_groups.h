#pragma once

#include <span>
#include <vector>

#include "multiscatter/path_vertex.h"

namespace mote {

/// Vertices that lie close together: a range of an order of theirs.
struct VertexGroup {
    size_t first = 0;
    size_t count = 0;
};

/// Splits vertices into groups of at most `most`, by the medians of their places. `order`: indices
/// of those that take part; sorted by group afterwards.
[[nodiscard]] std::vector<VertexGroup> make_groups(std::span<const PathVertex> vertices,
                                                   size_t most, std::vector<int>& order);

}  // namespace mote
