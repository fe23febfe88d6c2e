#pragma once

#include <memory>
#include <vector>

#include "volumes/tracking.h"

namespace mote {

/// What transmittances depend on: equal keys, equal transmittances. Holds on to the grids, so that
/// a new grid can never be taken for an old one at the same address.
struct MediaKey {
    struct Item {
        std::shared_ptr<const BrickGrid> density;
        float density_scale = 0.0f;
        MovingTransform world_from_object;
    };
    std::vector<Item> items;
};

[[nodiscard]] MediaKey media_key(const Media& media);

[[nodiscard]] bool operator==(const MediaKey& a, const MediaKey& b);

}  // namespace mote
