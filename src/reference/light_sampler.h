#pragma once

#include <memory>

#include "scene/path_tracer_params.h"
#include "scene/scene.h"

namespace mote {

/// What kind of emitter a light choice points to.
enum class LightSource { Lamp, Environment, EmissiveVolume };

/// Chooses lights at a point. Built once per frame; a scene with one light builds nothing.
class LightSampler;

}  // namespace mote
