#include "runs/method_rows.h"

namespace mote {

namespace {

/// With more lamps it takes minutes: every step asks every light.
constexpr int most_lights = 16;

}  // namespace

Method march_method()
{
    Method method;
    method.name = "march";
    method.doc = "fixed steps and a shadow grid, one scattering event, no noise; biased";
    method.is_reference = false;
    method.is_biased = true;
    method.keeps_history = true;  // its shadow grid stays where nothing moves
    method.samples_per_frame = 1;
    method.edit = [](RenderDescription& render) { render.estimator = EstimatorKind::March; };
    method.is_worthwhile = [](const SceneTraits& traits) {
        return traits.light_count <= most_lights && !traits.surfaces;
    };
    return method;
}

}  // namespace mote
