#pragma once

#include <string>

#include "core/buffer2d.h"
#include "core/math.h"

namespace mote {

/// How linear radiance becomes display colour.
enum class ViewTransform { Srgb, Filmic };

struct PreviewParams {
    float exposure = 0.0f;  ///< stops: radiance is multiplied by 2^exposure
    ViewTransform view = ViewTransform::Filmic;
};

/// 8-bit sRGB PNG of a linear RGB image. Atomic as write_exr. Throws Error(Output).
void write_png(const std::string& path, const Buffer2D<Spectrum>& image,
               const PreviewParams& params);

/// Reads an 8- or 16-bit PNG as linear RGB. Throws Error(Input).
[[nodiscard]] Buffer2D<Spectrum> read_png(const std::string& path);

}  // namespace mote
