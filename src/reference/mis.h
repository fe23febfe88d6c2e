#pragma once

#include "core/math.h"
#include "scene/path_tracer_params.h"

namespace mote {

/// Weight of a sample drawn with density `own` when another technique would draw it with density
/// `other` (one sample each, same measure). The weights of both sum to 1. Veach and Guibas 1995.
[[nodiscard]] inline float mis_weight(MisHeuristic heuristic, float own, float other)
{
    if (!(own > 0.0f)) return 0.0f;
    const float ratio = other / own;
    return 1.0f / (1.0f + (heuristic == MisHeuristic::Power ? ratio * ratio : ratio));
}

/// The same against two other techniques.
[[nodiscard]] inline float mis_weight(MisHeuristic heuristic, float own, float other_a,
                                      float other_b)
{
    if (!(own > 0.0f)) return 0.0f;
    const float a = other_a / own;
    const float b = other_b / own;
    return 1.0f / (1.0f + (heuristic == MisHeuristic::Power ? a * a + b * b : a + b));
}

}  // namespace mote
