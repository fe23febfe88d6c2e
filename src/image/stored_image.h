#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace mote {

/// An image file: on disk, or its bytes.
struct ImageSource {
    std::string path;                ///< of the file; with bytes: what messages call it
    std::span<const uint8_t> bytes;  ///< not empty: the file's content, already in memory
};

/// An image's values as its file stores them: R, G, B and, with four channels, A (1 where the file
/// has none), row by row from the top. Grey images have three equal channels.
struct StoredImage {
    int width = 0;
    int height = 0;
    int channels = 3;
    std::vector<uint8_t> bytes;  ///< of 8-bit files, in place of floats
    std::vector<float> floats;
};

}  // namespace mote
