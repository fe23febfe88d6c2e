#pragma once

#include <algorithm>
#include <cmath>

#include "core/math.h"

namespace mote {

/// Calls f(x, y) for up to `count` pixels around (x, y), none of them itself nor outside the image:
/// Vogel's spiral, even in area, at the golden angle, turned by `turn` [rad].
template <class F>
void for_each_neighbour(int x, int y, int width, int height, int count, float radius_px, float turn,
                        F&& f)
{
    for (int i = 0; i < count; ++i) {
        const float share = (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
        const float radius = std::max(1.0f, radius_px * std::sqrt(share));
        const float angle = turn + 2.39996323f * static_cast<float>(i);
        const int nx = x + static_cast<int>(std::lround(radius * std::cos(angle)));
        const int ny = y + static_cast<int>(std::lround(radius * std::sin(angle)));
        if (nx < 0 || ny < 0 || nx >= width || ny >= height || (nx == x && ny == y)) continue;
        f(nx, ny);
    }
}

}  // namespace mote
