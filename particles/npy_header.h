#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "particles/binary_rows.h"

namespace mote {

/// One field of a NumPy dtype; `name` is empty for a plain array.
struct NpyField {
    std::string name;
    RowField layout;
    int components = 1;  ///< 3 for a sub-array (3,); 0: nothing that mote reads
};

struct NpyHeader {
    std::vector<NpyField> fields;
    size_t item_size = 0;  ///< bytes of one element of the array
    bool is_structured = false;
    bool is_fortran = false;
    std::vector<uint64_t> shape;
};

/// Reads magic, version and the header dictionary, which is parsed strictly and never evaluated.
/// Throws Error(Input) naming the file and what is wrong.
[[nodiscard]] NpyHeader read_npy_header(InputFile& file);

}  // namespace mote
