#pragma once

#include <string>

namespace mote {

/// What an OpenEXR file holds, as text: size, layers, every channel with its range, metadata.
/// Throws as read_exr.
[[nodiscard]] std::string describe_image(const std::string& path);

}  // namespace mote
