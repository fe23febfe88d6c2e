#include "render/pixel_parts.h"

#include <algorithm>

#include "render/seen_look.h"

namespace mote {
namespace {

/// Rays that look alike.
struct Group {
    SeenLook look;
    int count = 0;
    bool has_main = false;
    Ray chosen;  ///< each of them with the same probability
};

/// Which stratum of n along an axis a place within a pixel lies in; far to the right, film points
/// are rounded to the pixel's end.
int stratum(float place, int n)
{
    return std::min(static_cast<int>(place * static_cast<float>(n)), n - 1);
}

}  // namespace

void split_pixel(const PassInputs& inputs, const PassKey& key, const Ray& main,
                 std::vector<PixelPart>& parts)
{
    parts.assign(1, {main, 1.0f});
    const int strata = inputs.split.parts.size() > 0 ? inputs.split.parts.at(key.x, key.y) : 1;
    if (strata < 2) return;
    const Surfaces& surfaces = *inputs.domain.scene->surfaces;
    const Vec2 main_place = camera_film(inputs, key) - Vec2(key.x, key.y);
    const int main_x = stratum(main_place.x, strata);
    const int main_y = stratum(main_place.y, strata);
    Rng rng = pass_rng(inputs, key, Stream::PixelRays);
    Group groups[most_parts];
    int count = 0;
    SeenLook look;
    // Groups must not depend on which of the rays is the main one: strata come in order.
    for (int sy = 0; sy < strata; ++sy) {
        for (int sx = 0; sx < strata; ++sx) {
            const bool is_main = sx == main_x && sy == main_y;
            const Ray ray = is_main ? main : stratum_ray(inputs, key, sx, sy, strata, rng);
            look = look_along(surfaces, ray, &look);
            int g = 0;
            while (g < count && !looks_alike(groups[g].look, look)) ++g;
            if (g == count && count < most_parts) groups[count++].look = look;
            // The rest join those with least: one ray for most of the pixel would be noisy.
            Group& group = g < count ? groups[g]
                                     : *std::min_element(groups, groups + count,
                                                         [](const Group& a, const Group& b) {
                                                             return a.count < b.count;
                                                         });
            group.has_main |= is_main;
            if (rng.uniform() * static_cast<float>(++group.count) < 1.0f) group.chosen = ray;
        }
    }
    const float share = 1.0f / static_cast<float>(strata * strata);
    for (int g = 0; g < count; ++g) {
        const float weight = share * static_cast<float>(groups[g].count);
        if (groups[g].has_main) {
            parts[0].weight = weight;
        } else {
            parts.push_back({groups[g].chosen, weight});
        }
    }
}

}  // namespace mote
