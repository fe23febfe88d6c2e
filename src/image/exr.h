#pragma once

#include <string>

#include "image/layers.h"

namespace mote {

enum class ExrCompression { None, Zip, Zips, Piz };

/// Writes a scanline OpenEXR. Atomic: a temporary file in the same folder is written, synced and
/// renamed, so `path` is either the old file or the whole new one. Throws Error(Output).
void write_exr(const std::string& path, const LayeredImage& image, ExrCompression compression);

/// Reads every channel as float. Throws Error(Input) naming the file; refuses damaged files and
/// data windows over 2^28 pixels.
[[nodiscard]] LayeredImage read_exr(const std::string& path);

}  // namespace mote
