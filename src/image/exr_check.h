#pragma once

#include <cstdint>
#include <string>

namespace mote {

/// Largest images that are read; beyond it a header is taken for damaged or hostile.
inline constexpr int64_t max_image_pixels = int64_t{1} << 28;
inline constexpr int64_t max_image_values = int64_t{1} << 30;  ///< over all channels

/// What an OpenEXR header claims, as far as it decides how much memory a reader will take.
struct ExrOutline {
    int64_t width = 0;
    int64_t height = 0;
    int64_t channel_count = 0;
};

/// Walks an OpenEXR header before a library parses it: every attribute must fit into the file and
/// the data window into the limits above and into what the file's size can hold. Throws
/// Error(Input) naming the file; refuses multi-part and deep files.
ExrOutline check_exr(const std::string& path);

}  // namespace mote
