#include "particles/binary_rows.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace mote {

namespace {

static_assert(std::endian::native == std::endian::little);

template <class T>
T load(const unsigned char* bytes, bool is_big_endian)
{
    unsigned char copy[sizeof(T)];
    std::memcpy(copy, bytes, sizeof(T));
    if (is_big_endian) std::reverse(copy, copy + sizeof(T));
    T value;
    std::memcpy(&value, copy, sizeof(T));
    return value;
}

NumberKind number_kind(ParticleAttribute attribute, ScalarType type)
{
    if (attribute != ParticleAttribute::Color) return NumberKind::Plain;
    if (type == ScalarType::U8) return NumberKind::Color8;
    return type == ScalarType::U16 ? NumberKind::Color16 : NumberKind::Plain;
}

}  // namespace

size_t scalar_size(ScalarType type)
{
    switch (type) {
        case ScalarType::I8:
        case ScalarType::U8:
            return 1;
        case ScalarType::I16:
        case ScalarType::U16:
            return 2;
        case ScalarType::I32:
        case ScalarType::U32:
        case ScalarType::F32:
            return 4;
        default:
            return 8;
    }
}

double load_scalar(const unsigned char* bytes, ScalarType type, bool is_big_endian)
{
    switch (type) {
        case ScalarType::I8:
            return load<int8_t>(bytes, false);
        case ScalarType::U8:
            return load<uint8_t>(bytes, false);
        case ScalarType::I16:
            return load<int16_t>(bytes, is_big_endian);
        case ScalarType::U16:
            return load<uint16_t>(bytes, is_big_endian);
        case ScalarType::I32:
            return load<int32_t>(bytes, is_big_endian);
        case ScalarType::U32:
            return load<uint32_t>(bytes, is_big_endian);
        case ScalarType::I64:
            return static_cast<double>(load<int64_t>(bytes, is_big_endian));
        case ScalarType::U64:
            return static_cast<double>(load<uint64_t>(bytes, is_big_endian));
        case ScalarType::F32:
            return double{load<float>(bytes, is_big_endian)};
        case ScalarType::F64:
            return load<double>(bytes, is_big_endian);
    }
    return 0.0;
}

void store_row(const RowLayout& layout, const unsigned char* bytes, size_t row, PointBuffer& buffer)
{
    for (const Binding& binding : buffer.bindings) {
        const RowField& field = layout.fields[binding.field];
        const unsigned char* at =
            bytes + field.offset +
            static_cast<size_t>(binding.field_component) * scalar_size(field.type);
        const bool is_wide = field.type == ScalarType::I64 || field.type == ScalarType::U64;
        if (binding.attribute == ParticleAttribute::Id && is_wide) {  // beyond what a double holds
            buffer.store_id(row, load<int64_t>(at, field.is_big_endian));
            continue;
        }
        buffer.store(binding, row, load_scalar(at, field.type, field.is_big_endian),
                     number_kind(binding.attribute, field.type));
    }
}

void read_rows(InputFile& file, const RowLayout& layout, size_t count, PointBuffer& buffer)
{
    const size_t rows_at_once =
        std::max<size_t>(1, InputFile::max_take / std::max<size_t>(layout.size, 1));
    for (size_t row = 0; row < count;) {
        const size_t rows = std::min(rows_at_once, count - row);
        const unsigned char* bytes = file.take(rows * layout.size);
        for (size_t i = 0; i < rows; ++i, ++row) {
            store_row(layout, bytes + i * layout.size, row, buffer);
        }
    }
}

}  // namespace mote
