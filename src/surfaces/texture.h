#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/math.h"

namespace mote {

using Rgba = glm::vec4;

/// What lies beyond a picture's edges.
enum class TextureWrap {
    Repeat,  ///< the picture again
    Clamp,   ///< its outermost texels
    Mirror,  ///< the picture, turned over from one to the next
};

/// How a picture is looked up, as in glTF.
struct TextureSampler {
    TextureWrap u = TextureWrap::Repeat;
    TextureWrap v = TextureWrap::Repeat;
    bool is_nearest = false;  ///< the nearest texel's value; else bilinear between four

    bool operator==(const TextureSampler&) const = default;
};

/// A picture on a surface, in linear values, without end: a sampler says how it goes on. u runs to
/// the right, v upwards: (0, 0) is the lower left corner of the picture. Cost of a look-up: about
/// 20 ns, 160 ns where it misses all caches.
class Texture {
  public:
    /// 8-bit RGBA, rows from the top; RGB by the sRGB curve if is_srgb. Asserts the sizes.
    Texture(int width, int height, std::vector<uint8_t> rgba, bool is_srgb,
            const TextureSampler& sampler = {});
    /// Linear RGBA, rows from the top. Asserts the sizes.
    Texture(int width, int height, std::vector<float> rgba, const TextureSampler& sampler = {});

    [[nodiscard]] Rgba at(Vec2 uv) const;

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] size_t memory_bytes() const { return bytes_.size() + floats_.size() * 4; }

  private:
    [[nodiscard]] Rgba texel(int x, int y) const;

    int width_ = 0;
    int height_ = 0;
    std::vector<uint8_t> bytes_;
    std::vector<float> floats_;           ///< where there are no bytes
    const float* color_table_ = nullptr;  ///< linear value of a byte
    TextureSampler sampler_;
};

}  // namespace mote
