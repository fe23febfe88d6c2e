#pragma once

#include <vector>

#include "core/buffer2d.h"
#include "core/parallel.h"
#include "restir/pixel_domain.h"

namespace mote {

/// The domains of a pass's pixels, packed: 56 bytes per pixel and 12 per bin edge (about 30 on
/// rays through smoke, none elsewhere). Kept as long as the pass's reservoirs are.
class DomainStore {
  public:
    DomainStore() = default;
    DomainStore(int width, int height);

    /// Stores a pixel's domain. Pixels of one tile must be stored by one thread.
    void store(int x, int y, const PixelDomain& domain);

    /// Unpacks a pixel's domain.
    void load(int x, int y, PixelDomain& domain) const;

    [[nodiscard]] const Ray& ray(int x, int y) const { return headers_.at(x, y).ray; }

    /// Optical depth of the pixel's whole ray, without unpacking it.
    [[nodiscard]] float depth(int x, int y) const { return headers_.at(x, y).depth; }

    [[nodiscard]] bool empty() const { return headers_.size() == 0; }
    [[nodiscard]] int width() const { return headers_.width(); }
    [[nodiscard]] int height() const { return headers_.height(); }
    [[nodiscard]] size_t memory_bytes() const;

  private:
    struct Header {
        Ray ray;
        double t0 = 0.0;
        float depth = 0.0f;
        int32_t count = 0;
        uint32_t first = 0;  ///< edge in the tile's array
    };
    struct Edge {
        float s, tau, cdf;
    };
    [[nodiscard]] size_t tile_of(int x, int y) const
    {
        return static_cast<size_t>(y / image_tile_size) * tiles_across_ +
               static_cast<size_t>(x / image_tile_size);
    }

    Buffer2D<Header> headers_;
    size_t tiles_across_ = 0;
    std::vector<std::vector<Edge>> edges_;  ///< per tile
};

}  // namespace mote
