#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace mote {

/// A JPEG file without all that does not decode pixels (EXIF, IPTC, XMP, colour profiles,
/// thumbnails, comments): what is left is read by libjpeg alone, which is a hardened parser, unlike
/// those of metadata. Baseline and progressive files, grey or of three components, of at most
/// max_image_pixels, with an end, and of so few scans that decoding cannot take for ever. Empty
/// with `error` set for all others: one sentence, without the file's name.
[[nodiscard]] std::vector<uint8_t> bare_jpeg(std::span<const uint8_t> file, std::string& error);

}  // namespace mote
