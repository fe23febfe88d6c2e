#pragma once

#include <cstdint>
#include <string>

#include "core/buffer2d.h"
#include "core/math.h"
#include "image/stored_image.h"

namespace mote {

/// Pixel values that cannot be radiance and were replaced by 0.
struct ImageReadReport {
    int64_t non_finite = 0;
    int64_t negative = 0;
};

/// Reads an environment map as linear RGB: .exr and .hdr as they are, .png and .jpg decoded from
/// sRGB; one-channel images become grey. Nothing else is read, and a file's first bytes must agree
/// with its extension: the libraries behind are not hardened parsers, which is why of JPEG they see
/// no more than the coded pixels (see bare_jpeg). They are loaded at the first
/// call (hundreds of shared objects), so scenes without images do not pay for them. Throws
/// Error(Input) naming the file; limits as read_exr.
[[nodiscard]] Buffer2D<Spectrum> read_image(const std::string& path,
                                            ImageReadReport* report = nullptr);

/// Reads a texture as stored, with alpha: the same formats by the same rules; from bytes PNG and
/// JPEG (`path` is then only a name).
/// Throws as read_image.
[[nodiscard]] StoredImage read_stored_image(const ImageSource& source);

/// Whether a file stores colours by the sRGB curve: PNG and JPEG do.
[[nodiscard]] bool stores_srgb(const ImageSource& source);

}  // namespace mote
