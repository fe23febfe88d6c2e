#pragma once

#include "verify/tiles.h"

namespace mote {

/// Judges the tiles of a comparison again, so that rare samples raise no false alarm: rewrites
/// their test results, p_tiles and p. Of few runs a t-test trusts the scatter that it sees, and
/// that is none where all runs of one side missed what comes once in a thousand samples. Hence
///
/// - a variance of the tested runs below a quarter of the usual multiple of the reference's (the
///   median over the channel's tiles) is replaced by that multiple, as if under the null hypothesis
///   both saw the same light;
/// - differences that ten missed hits of a sample explain, in tiles as they are in this channel,
/// are
///   no bias;
/// - differences below `tolerance` times the channel's scale (see channel_scale) are no bias.
///
/// All only make p larger. What they cost is power in single tiles, against small biases and where
/// the tested estimator is much better than elsewhere; the whole image is judged without them.
void judge_tiles(const TileStats& tested, const TileStats& reference, double tolerance,
                 RunComparison& comparison);

/// What biases of a channel are relative to [same unit as the channel]. Parts of the radiance: the
/// picture's mean, over R, G and B, of the reference; others as alpha: their own mean. A part that
/// is black in the picture cannot be a large share of it, whatever its own relative error.
[[nodiscard]] double channel_scale(const TileStats& reference, const std::string& channel);

}  // namespace mote
