#pragma once

#include <string>

#include "core/buffer2d.h"
#include "core/math.h"
#include "image/png.h"
#include "verify/tiles.h"

namespace mote {

/// Mean over the runs, of statistics with tiles of one pixel: linear radiance.
[[nodiscard]] Buffer2D<Spectrum> mean_picture(const TileStats& pixels);

/// t of tested - reference where |t| is largest among R, G and B, per pixel of statistics with
/// tiles of one pixel. Red brighter, blue darker, full colour at +-full_t. Display colours.
[[nodiscard]] Buffer2D<Spectrum> pixel_t_picture(const TileStats& tested,
                                                 const TileStats& reference, double full_t);

/// The same per tile of a comparison, one pixel each.
[[nodiscard]] Buffer2D<Spectrum> tile_t_picture(const RunComparison& comparison, double full_t);

/// Standard deviation of a run over the runs, grey per pixel: white from the 99th percentile on.
[[nodiscard]] Buffer2D<Spectrum> noise_picture(const TileStats& pixels);

/// A picture as PNG in a data URI, to stand in a page. Throws Error(Output) as encode_png.
[[nodiscard]] std::string data_uri(const Buffer2D<Spectrum>& picture, const PreviewParams& view);

/// RFC 4648, padded.
[[nodiscard]] std::string base64(std::string_view bytes);

}  // namespace mote
