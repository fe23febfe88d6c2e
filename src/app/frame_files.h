#pragma once

#include <string>
#include <vector>

#include "app/options.h"

namespace mote {

/// The files of one frame.
struct FrameFiles {
    int frame = 0;
    std::string image;    ///< OpenEXR
    std::string preview;  ///< PNG; empty: none
};

/// Expands both patterns (`preview` may be empty). Throws Error(Usage) if frames would share a
/// file or the extensions are not .exr and .png.
[[nodiscard]] std::vector<FrameFiles> frame_files(const std::vector<int>& frames,
                                                  const std::string& image_pattern,
                                                  const std::string& preview_pattern);

/// What a file must be to stand for a frame that would be rendered now.
struct ExpectedImage {
    int width = 0;
    int height = 0;
    std::string scene_hash;
    std::string inputs_hash;  ///< of the input files as they are now; "": it needs none
};

/// Whether a frame's image is kept, and why or why not in a few words.
struct ExistingImage {
    bool keep = false;
    std::string reason;
};

/// Looks at the image of a frame. Skip keeps every OpenEXR file whose pixels can all be read:
/// existing is not enough, a killed copy exists too. Verify also compares size, scene hash (it
/// covers everything that changes the picture: samples, seed, layers, overrides) and the hash of
/// the input files (path, size and modification time of each). Costs a read of the file.
[[nodiscard]] ExistingImage check_existing(const std::string& path, ExistingMode mode,
                                           const ExpectedImage& expected);

/// Throws Error(Output) now if a new file could not be created in the folder of `path`, rather
/// than after the render. Creates missing folders.
void require_writable_folder(const std::string& path);

/// Removes the temporary files of this process next to `files`; for an exit that runs no
/// destructors.
void remove_own_temporaries(const std::vector<FrameFiles>& files);

}  // namespace mote
