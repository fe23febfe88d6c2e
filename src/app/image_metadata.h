#pragma once

#include "image/layers.h"
#include "scene/description.h"

namespace mote {

/// Sixteen hexadecimal digits of the scene's hash, as written into images.
[[nodiscard]] std::string scene_hash_text(const SceneDescription& scene);

/// Adds what a file should tell of its making: program, hashes of the scene and of its input files
/// (inputs_hash, left out if ""), frame, seed, estimator and
/// samples, frame rate; and date and render time [s] unless `reproducible`, which makes files of
/// equal pixels equal byte for byte. Replaces entries of the same name.
void add_metadata(LayeredImage& image, const SceneDescription& scene, int frame,
                  const std::string& inputs_hash, double render_seconds, bool reproducible);

/// Frames per second as a fraction: 23.976 is 24000/1001.
[[nodiscard]] Attribute::Rational frame_rate(double fps);

}  // namespace mote
