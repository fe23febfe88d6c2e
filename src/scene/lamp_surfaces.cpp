#include "scene/lamp_surfaces.h"

namespace mote {
namespace {

/// Up to this many lamps are tried one by one.
constexpr size_t few_lamps = 4;

}  // namespace

LampSurfaces::LampSurfaces(std::span<const Light> lights)
{
    std::vector<BoxTree::Item> items;
    for (size_t i = 0; i < lights.size(); ++i) {
        const Light& light = lights[i];
        const bool is_met =
            std::holds_alternative<SphereLight>(light) || std::holds_alternative<QuadLight>(light);
        if (!is_met || !(light_power(light, 1.0f) > 0.0f)) continue;
        items.push_back({static_cast<int>(i), light_bounds(light)});
    }
    if (items.size() > few_lamps) {
        tree_ = BoxTree(std::move(items));
    } else {
        for (const BoxTree::Item& item : items) few_.push_back(item.id);
    }
}

}  // namespace mote
