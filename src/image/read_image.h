#pragma once

#include <cstdint>
#include <string>

#include "core/buffer2d.h"
#include "core/math.h"

namespace mote {

/// Pixel values that cannot be radiance and were replaced by 0.
struct ImageReadReport {
    int64_t non_finite = 0;
    int64_t negative = 0;
};

/// Reads a texture or environment map as linear RGB: .exr and .hdr as they are, .png decoded from
/// sRGB; one-channel images become grey. Nothing else is read, and a file's first bytes must agree
/// with its extension: the libraries behind are not hardened parsers. They are loaded at the first
/// call (hundreds of shared objects), so scenes without images do not pay for them. Throws
/// Error(Input) naming the file; limits as read_exr.
[[nodiscard]] Buffer2D<Spectrum> read_image(const std::string& path,
                                            ImageReadReport* report = nullptr);

}  // namespace mote
