#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "particles/binary_rows.h"

namespace mote {

struct PlyProperty {
    std::string name;
    ScalarType type = ScalarType::F32;
    std::optional<ScalarType> list_count;  ///< a list: the type of its length
};

struct PlyElement {
    std::string name;
    uint64_t count = 0;
    std::vector<PlyProperty> properties;

    [[nodiscard]] bool has_lists() const;
    /// Bytes of a binary row in which all lists are empty.
    [[nodiscard]] size_t smallest_row() const;
};

enum class PlyFormat { Ascii, LittleEndian, BigEndian };

struct PlyHeader {
    PlyFormat format = PlyFormat::Ascii;
    std::vector<PlyElement> elements;
};

/// Reads up to and including "end_header". Throws Error(Input) with file:line:column.
[[nodiscard]] PlyHeader read_ply_header(InputFile& file);

}  // namespace mote
