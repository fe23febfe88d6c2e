#include "surfaces/texture.h"

#include <algorithm>

#include "core/error.h"
#include "image/color.h"

namespace mote {
namespace {

using ByteTable = std::array<float, 256>;

ByteTable make_table(bool is_srgb)
{
    ByteTable table{};
    for (size_t i = 0; i < table.size(); ++i) {
        const float value = static_cast<float>(i) / 255.0f;
        table[i] = is_srgb ? decode_srgb(value) : value;
    }
    return table;
}

const ByteTable& table_of(bool is_srgb)
{
    static const ByteTable srgb = make_table(true);
    static const ByteTable linear = make_table(false);
    return is_srgb ? srgb : linear;
}

/// Number of values of a picture of four channels.
size_t value_count(int width, int height)
{
    return 4 * static_cast<size_t>(width) * static_cast<size_t>(height);
}

/// The two texels around a coordinate along one axis, and the share of the second.
struct Neighbours {
    int first = 0;
    int second = 0;
    float share = 0.0f;
};

Neighbours neighbours(float coordinate, int size, TextureWrap wrap, bool is_nearest)
{
    float within = coordinate - std::floor(coordinate);  // [0,1], the 1 by rounding
    if (wrap == TextureWrap::Clamp) within = std::clamp(coordinate, 0.0f, 1.0f);
    if (wrap == TextureWrap::Mirror) {
        const float twice = coordinate - 2.0f * std::floor(0.5f * coordinate);  // [0,2]
        within = std::min(twice, 2.0f - twice);
    }
    const int last = size - 1;
    if (is_nearest) {
        const int nearest = std::min(static_cast<int>(within * static_cast<float>(size)), last);
        return {nearest, nearest, 0.0f};
    }
    const float x = within * static_cast<float>(size) - 0.5f;
    const float lower = std::floor(x);
    const int first = static_cast<int>(lower);
    const bool repeats = wrap == TextureWrap::Repeat;
    const int before = repeats ? last : 0;  // of the picture's first texel
    const int after = repeats ? 0 : last;   // of its last
    return {first < 0 ? before : std::min(first, last), first + 1 > last ? after : first + 1,
            x - lower};
}

}  // namespace

Texture::Texture(int width, int height, std::vector<uint8_t> rgba, bool is_srgb,
                 const TextureSampler& sampler)
    : width_(width),
      height_(height),
      bytes_(std::move(rgba)),
      color_table_(table_of(is_srgb).data()),
      sampler_(sampler)
{
    MOTE_ASSERT(width > 0 && height > 0 && bytes_.size() == value_count(width, height));
}

Texture::Texture(int width, int height, std::vector<float> rgba, const TextureSampler& sampler)
    : width_(width), height_(height), floats_(std::move(rgba)), sampler_(sampler)
{
    MOTE_ASSERT(width > 0 && height > 0 && floats_.size() == value_count(width, height));
}

Rgba Texture::texel(int x, int y) const
{
    const size_t i =
        4 * (static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x));
    if (bytes_.empty()) return {floats_[i], floats_[i + 1], floats_[i + 2], floats_[i + 3]};
    const uint8_t* b = &bytes_[i];
    return {color_table_[b[0]], color_table_[b[1]], color_table_[b[2]],
            static_cast<float>(b[3]) / 255.0f};
}

Rgba Texture::at(Vec2 uv) const
{
    const Neighbours x = neighbours(uv.x, width_, sampler_.u, sampler_.is_nearest);
    const Neighbours y = neighbours(1.0f - uv.y, height_, sampler_.v, sampler_.is_nearest);
    const Rgba top = glm::mix(texel(x.first, y.first), texel(x.second, y.first), x.share);
    const Rgba bottom = glm::mix(texel(x.first, y.second), texel(x.second, y.second), x.share);
    return glm::mix(top, bottom, y.share);
}

}  // namespace mote
