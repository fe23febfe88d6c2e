#pragma once

#include <cstdint>
#include <string>

#include "particles/point_buffer.h"

namespace mote {

/// What a child process found in a file, at the head of the memory it shares with its parent.
struct SharedHeader {
    uint64_t count = 0;
    bool is_present[attribute_count] = {};
    char field_names[attribute_count][64] = {};
};

/// Room for `capacity` particles that a forked child fills for its parent: one array for each
/// attribute, of float, Vec3 or (ids) int64_t. Pages exist once they are touched, so room for the
/// largest possible result costs nothing.
class SharedColumns {
  public:
    /// Throws Error(Memory) naming the file.
    SharedColumns(const std::string& file, size_t capacity);
    ~SharedColumns();
    SharedColumns(const SharedColumns&) = delete;
    SharedColumns& operator=(const SharedColumns&) = delete;

    [[nodiscard]] size_t capacity() const { return capacity_; }
    [[nodiscard]] SharedHeader& header() const;
    [[nodiscard]] char* column(ParticleAttribute attribute) const;
    /// Copies the present columns.
    [[nodiscard]] PointBuffer to_buffer() const;

  private:
    size_t capacity_;
    size_t bytes_;
    void* start_;
};

}  // namespace mote
