#pragma once

#include <string>

namespace mote {

/// ".exr" from "frames/A.EXR": the extension with its dot, ASCII letters in lower case; "" if none.
[[nodiscard]] std::string lower_extension(const std::string& path);

}  // namespace mote
