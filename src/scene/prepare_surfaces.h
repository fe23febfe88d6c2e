#pragma once

#include "scene/grid_cache.h"

namespace mote {

/// Which frame, and when the shutter opens and closes [frames].
struct ShutterTimes {
    int frame = 1;
    double open = 1.0;
    double close = 1.0;
};

/// Fills everything of a scene that comes of [[objects]]: surfaces, the lights of emissive ones
/// (after the lamps that are there) and, if there is a next frame, where they are then. Meshes are
/// kept between frames by file; the tree over the instances while nothing moves. Nothing is made
/// for a frame without objects. Throws Error(Input) naming the file.
void prepare_surfaces(const SceneDescription& description, const ShutterTimes& times,
                      SceneCache::Impl& cache, PrepareStats& stats, Scene& scene);

}  // namespace mote
