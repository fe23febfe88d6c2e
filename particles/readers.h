#pragma once

#include <string>

#include "particles/point_buffer.h"
#include "particles/source.h"

/// One reader per file format, each in its own file. All check the counts that a header claims
/// against the size of the file before they allocate, and throw Error(Input) naming
/// file:line:column for text and file and attribute for binary formats.
namespace mote {

/// What to read from a file.
struct PointRequest {
    const CacheParams& params;
    const AttributeMask& mask;
    /// Stop after the header: which attributes there are and whether the file is as long as it
    /// claims, but no rows. The header of .vdb points does not name their attributes.
    bool header_only = false;
};

/// PLY 1.0: ascii and binary of both byte orders, any properties. Only the element "vertex" is
/// read, other elements and list properties are skipped.
[[nodiscard]] PointBuffer read_ply(const std::string& path, const PointRequest& request);

/// Text table with a row of names first (or last in the comments above the numbers, as
/// numpy.savetxt writes it). Separator: the first of tab ; , that the names hold, else blanks.
/// "#" starts a comment. Colours are linear.
[[nodiscard]] PointBuffer read_csv(const std::string& path, const PointRequest& request);

/// NumPy .npy, versions 1 to 3: an array (N, 3) of numbers is positions only, a structured array
/// has named fields, each a number or three; C and Fortran order.
[[nodiscard]] PointBuffer read_npy(const std::string& path, const PointRequest& request);

/// Every PointDataGrid of an OpenVDB file, one after the other. Attributes of any codec.
[[nodiscard]] PointBuffer read_vdb_points(const std::string& path, const PointRequest& request);

}  // namespace mote
