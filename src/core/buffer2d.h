#pragma once

#include <vector>

#include "core/error.h"

namespace mote {

/// Image-shaped array [width x height], row-major, origin top-left.
template <class T>
class Buffer2D {
  public:
    Buffer2D() = default;
    Buffer2D(int width, int height, const T& value = T{})
        : width_(width),
          height_(height),
          data_(static_cast<size_t>(width) * static_cast<size_t>(height), value)
    {
    }

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] size_t size() const { return data_.size(); }
    [[nodiscard]] T* data() { return data_.data(); }
    [[nodiscard]] const T* data() const { return data_.data(); }
    [[nodiscard]] T& at(int x, int y) { return data_[index(x, y)]; }
    [[nodiscard]] const T& at(int x, int y) const { return data_[index(x, y)]; }
    [[nodiscard]] auto begin() { return data_.begin(); }
    [[nodiscard]] auto end() { return data_.end(); }
    [[nodiscard]] auto begin() const { return data_.begin(); }
    [[nodiscard]] auto end() const { return data_.end(); }

  private:
    [[nodiscard]] size_t index(int x, int y) const
    {
        MOTE_ASSERT(x >= 0 && x < width_ && y >= 0 && y < height_);
        return static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x);
    }

    int width_ = 0;
    int height_ = 0;
    std::vector<T> data_;
};

}  // namespace mote
