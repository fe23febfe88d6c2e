#pragma once

#include <string>
#include <vector>

#include "core/buffer2d.h"
#include "core/math.h"

namespace mote {

/// How linear radiance becomes display colour.
enum class ViewTransform { Srgb, Filmic };

struct PreviewParams {
    float exposure = 0.0f;  ///< stops: radiance is multiplied by 2^exposure
    ViewTransform view = ViewTransform::Filmic;
};

/// Linear display colour in [0,1] of linear scene radiance; see color.h for the filmic curve.
[[nodiscard]] Spectrum apply_view(Spectrum radiance, const PreviewParams& params);

/// 8-bit sRGB PNG of a linear RGB image. Atomic as write_exr. Throws Error(Output).
void write_png(const std::string& path, const Buffer2D<Spectrum>& image,
               const PreviewParams& params);

/// The bytes of that file. Throws Error(Output) if libpng fails.
[[nodiscard]] std::vector<char> encode_png(const Buffer2D<Spectrum>& image,
                                           const PreviewParams& params);

/// Reads a PNG as linear RGB, alpha ignored; 16-bit files are rounded to 8 bits (read_image keeps
/// them). Throws Error(Input) naming the file; refuses damaged files and more than 2^28 pixels.
[[nodiscard]] Buffer2D<Spectrum> read_png(const std::string& path);

}  // namespace mote
