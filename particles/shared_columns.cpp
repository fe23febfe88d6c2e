#include "particles/shared_columns.h"

#include <cstring>

#include <sys/mman.h>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"

namespace mote {

namespace {

size_t value_bytes(ParticleAttribute attribute)
{
    if (attribute == ParticleAttribute::Id) return sizeof(int64_t);
    return sizeof(float) * static_cast<size_t>(attribute_components(attribute));
}

size_t align(size_t bytes)
{
    return (bytes + 63) / 64 * 64;
}

/// Where the column of attribute number `attribute` starts; attribute_count: the end of all.
size_t column_offset(int attribute, size_t capacity)
{
    size_t offset = align(sizeof(SharedHeader));
    for (int a = 0; a < attribute; ++a) {
        offset += align(capacity * value_bytes(static_cast<ParticleAttribute>(a)));
    }
    return offset;
}

template <class T>
void copy_column(const SharedColumns& columns, ParticleAttribute attribute, std::vector<T>& to)
{
    if (to.empty()) return;
    std::memcpy(static_cast<void*>(to.data()), columns.column(attribute), to.size() * sizeof(T));
}

}  // namespace

SharedColumns::SharedColumns(const std::string& file, size_t capacity)
    : capacity_(capacity), bytes_(column_offset(attribute_count, capacity))
{
    start_ = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE,
                  MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (start_ == MAP_FAILED) {
        throw Error(ExitCode::Memory, fmt::format("{}: no memory to read it into ({})", file,
                                                  format_bytes(static_cast<double>(bytes_))));
    }
    new (start_) SharedHeader;
}

SharedColumns::~SharedColumns()
{
    munmap(start_, bytes_);
}

SharedHeader& SharedColumns::header() const
{
    return *static_cast<SharedHeader*>(start_);
}

char* SharedColumns::column(ParticleAttribute attribute) const
{
    return static_cast<char*>(start_) + column_offset(static_cast<int>(attribute), capacity_);
}

PointBuffer SharedColumns::to_buffer() const
{
    PointBuffer buffer;
    for (int a = 0; a < attribute_count; ++a) {
        if (!header().is_present[a]) continue;
        const auto attribute = static_cast<ParticleAttribute>(a);
        const int components = attribute_components(attribute);
        for (int c = 0; c < components; ++c) {
            buffer.bindings.push_back({attribute, c, buffer.fields.size(), c});
        }
        buffer.fields.push_back({header().field_names[a], components});
    }
    buffer.resize(header().count);
    copy_column(*this, ParticleAttribute::Position, buffer.set.position);
    copy_column(*this, ParticleAttribute::Velocity, buffer.set.velocity);
    copy_column(*this, ParticleAttribute::Radius, buffer.set.radius);
    copy_column(*this, ParticleAttribute::Mass, buffer.set.mass);
    copy_column(*this, ParticleAttribute::Density, buffer.density);
    copy_column(*this, ParticleAttribute::Temperature, buffer.set.temperature);
    copy_column(*this, ParticleAttribute::Color, buffer.set.color);
    copy_column(*this, ParticleAttribute::Id, buffer.set.id);
    copy_column(*this, ParticleAttribute::Age, buffer.set.age);
    return buffer;
}

}  // namespace mote
