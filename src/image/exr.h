#pragma once

#include <string>

#include "image/layers.h"

namespace mote {

enum class ExrCompression { None, Zip, Zips, Piz };

/// Writes a scanline OpenEXR. Atomic: a temporary file in the same folder is written, synced and
/// renamed, so `path` is either the old file or the whole new one. Finite values beyond the range
/// of half become +-65504 in half channels. Compresses on as many threads as TBB may use; the
/// bytes do not depend on it. Throws Error(Output).
void write_exr(const std::string& path, const LayeredImage& image, ExrCompression compression);

/// Reads every channel of a single-part file as float. Throws Error(Input) naming the file;
/// refuses damaged, incomplete, deep and multi-part files, subsampled channels, and data windows
/// over 2^28 pixels or 2^30 values.
[[nodiscard]] LayeredImage read_exr(const std::string& path);

/// Size, channels (with empty data) and attributes without the pixels: cheap at any size. Throws
/// as read_exr.
[[nodiscard]] LayeredImage read_exr_header(const std::string& path);

/// Whether `path` is an OpenEXR file of which every pixel can be read. Costs a full read; a
/// render that was killed, a copy that was cut short and a missing file all give false.
[[nodiscard]] bool is_complete_exr(const std::string& path);

}  // namespace mote
