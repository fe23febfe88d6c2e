#pragma once

#include <cstdint>
#include <vector>

#include "particles/input_file.h"
#include "particles/point_buffer.h"

namespace mote {

enum class ScalarType { I8, U8, I16, U16, I32, U32, I64, U64, F32, F64 };

[[nodiscard]] size_t scalar_size(ScalarType type);

/// Where a field lies in a row of fixed size.
struct RowField {
    ScalarType type = ScalarType::F32;
    size_t offset = 0;  ///< of its first component [bytes]; the others follow
    bool is_big_endian = false;
};

/// Rows of fixed size, field `i` of the file at `fields[i]`.
struct RowLayout {
    size_t size = 0;  ///< [bytes]
    std::vector<RowField> fields;
};

[[nodiscard]] double load_scalar(const unsigned char* bytes, ScalarType type, bool is_big_endian);

/// Stores the bound numbers of one row, which lies at `bytes`.
void store_row(const RowLayout& layout, const unsigned char* bytes, size_t row,
               PointBuffer& buffer);

/// Reads `count` rows; the caller has checked that the file holds them.
void read_rows(InputFile& file, const RowLayout& layout, size_t count, PointBuffer& buffer);

}  // namespace mote
