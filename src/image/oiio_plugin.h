#pragma once

#include <string>

#include "core/buffer2d.h"
#include "core/math.h"

namespace mote {

/// The one function of the image reader module (a shared library of its own, loaded on demand).
/// Reads `path` with OpenImageIO's reader called `format` and no other; false with `error` set.
/// Values come as stored, no colour conversion.
using ReadWithOiio = bool (*)(const char* path, const char* format, Buffer2D<Spectrum>& out,
                              std::string& error);
inline constexpr const char* oiio_plugin_symbol = "mote_read_with_oiio";
inline constexpr const char* oiio_plugin_file = "libmote_oiio.so";

}  // namespace mote
