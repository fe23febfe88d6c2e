#pragma once

#include <string>
#include <vector>

namespace mote {

struct ContactSheetParams {
    int columns = 6;       ///< images per row
    int cell_width = 320;  ///< largest width of one image [px]; wider ones are scaled down
    int gap = 4;           ///< dark border between images [px]
};

/// Writes one PNG that shows the given PNG images row by row. All images must have one size.
/// Throws Error(Input) naming the image that is missing or differs, Error(Output) as write_png.
void make_contact_sheet(const std::vector<std::string>& image_paths,
                        const ContactSheetParams& params, const std::string& out_path);

}  // namespace mote
