#pragma once

#include <string>

#include "image/stored_image.h"

namespace mote {

/// The one function of the image reader module (a shared library of its own, loaded on demand).
/// Reads `source` with OpenImageIO's reader called `format` and no other, into 3 or 4 channels;
/// false with `error` set. Values come as stored, no colour conversion.
using ReadWithOiio = bool (*)(const ImageSource& source, const char* format, int channels,
                              StoredImage& out, std::string& error);
inline constexpr const char* oiio_plugin_symbol = "mote_read_with_oiio";
inline constexpr const char* oiio_plugin_file = "libmote_oiio.so";

}  // namespace mote
