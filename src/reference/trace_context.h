#pragma once

#include "reference/light_sampler.h"
#include "reference/shadow_guess.h"
#include "scene/path_tracer_params.h"
#include "scene/scene.h"

namespace mote {

struct AimedLights;

/// What every part of the path tracer needs to see.
struct TraceContext {
    const Scene& scene;
    const LightSampler& lights;
    const PathTracerParams& params;
    const ShadowGuess* shadows = nullptr;  ///< null: every shadow is asked for
    const LightGuide* guide = nullptr;     ///< null: lights are chosen by the sampler alone
    const AimedLights* aims = nullptr;     ///< null: walks do not aim at lights
};

}  // namespace mote
