#pragma once

#include <string>
#include <vector>

#include "image/layers.h"

namespace mote {

/// Light that comes to the camera without any event: lamps, sky and what glows, dimmed by media.
/// Where small lamps are in view most of a picture's noise is whether rays meet them, which says
/// nothing of how light is resampled. Expectations add up, so these parts of a run may come from
/// frames of no events, which are cheap: many passes leave little of that noise.
struct StraightLight {
    std::vector<std::string> parts;  ///< layers; empty: the runs are taken as they are
    bool plays_frames = false;  ///< of runs that keep history: all their frames without events,
                                ///< as often as gives these passes; else the last one alone
    int tested_passes = 0;      ///< of frames without events, per run
    int reference_passes = 0;
};

/// Those `among` the layers that hold such light and are the same bit by bit in both images, of the
/// same random numbers with events and without: what events, or frames before, change in any way is
/// left alone. Both images have the layers (asserted).
[[nodiscard]] std::vector<std::string> straight_parts(const LayeredImage& with_events,
                                                      const LayeredImage& without,
                                                      const std::vector<std::string>& among);

/// Takes the parts of `image` from `source`, and changes R, G and B by the difference. Both have
/// these layers (asserted).
void replace_parts(LayeredImage& image, const LayeredImage& source,
                   const std::vector<std::string>& parts);

/// Adds `factor` times the image to a sum of such images, which begins empty.
void add_image(LayeredImage& sum, const LayeredImage& image, float factor);

/// The parts' sum as R, G and B, or what is left of those without them.
[[nodiscard]] LayeredImage only_parts(const LayeredImage& image,
                                      const std::vector<std::string>& parts);
[[nodiscard]] LayeredImage without_parts(const LayeredImage& image,
                                         const std::vector<std::string>& parts);

/// Passes without events, of one estimator, for which variance times time is least, where all else
/// of both takes `rest_seconds` a run and has `rest_variance`. At least 1; at most 1024, and no
/// more than make runs a few times as long.
[[nodiscard]] int best_straight_passes(double pass_variance, double pass_seconds,
                                       double rest_variance, double rest_seconds);

}  // namespace mote
