#include "scene/texture_cache.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "core/text.h"
#include "image/color.h"
#include "image/read_image.h"

namespace mote {
namespace {

/// Values of a picture of floats, made linear and fit to multiply by.
void finish(std::vector<float>& values, bool is_srgb, const std::string& path)
{
    size_t bad = 0;
    for (size_t i = 0; i < values.size(); ++i) {
        float& value = values[i];
        if (!(value >= 0.0f && std::isfinite(value))) {
            value = 0.0f;
            ++bad;
        }
        if (is_srgb && i % 4 != 3) value = decode_srgb(value);
    }
    if (bad > 0) {
        spdlog::warn("{}: {} values are negative or not finite; taken as 0", printable(path), bad);
    }
}

std::shared_ptr<const Texture> make_texture(const ImageSource& source, TextureRole role,
                                            const TextureSampler& sampler)
{
    StoredImage image = read_stored_image(source);
    const bool is_srgb = role == TextureRole::Color && stores_srgb(source);
    if (!image.bytes.empty()) {
        return std::make_shared<const Texture>(image.width, image.height, std::move(image.bytes),
                                               is_srgb, sampler);
    }
    finish(image.floats, is_srgb, source.path);
    return std::make_shared<const Texture>(image.width, image.height, std::move(image.floats),
                                           sampler);
}

}  // namespace

std::shared_ptr<const Texture> TextureCache::get(const ImageSource& source,
                                                 const std::string& version, TextureRole role,
                                                 const TextureSampler& sampler)
{
    const std::string key =
        fmt::format("{} {} {} {} {}", version, role == TextureRole::Color ? "color" : "data",
                    static_cast<int>(sampler.u), static_cast<int>(sampler.v), sampler.is_nearest);
    auto& texture = held_[key];
    if (!texture) texture = make_texture(source, role, sampler);
    return texture;
}

void TextureCache::drop_unused()
{
    for (auto it = held_.begin(); it != held_.end();) {
        it = it->second.use_count() > 1 ? std::next(it) : held_.erase(it);
    }
}

size_t TextureCache::memory_bytes() const
{
    size_t bytes = 0;
    for (const auto& [version, texture] : held_) bytes += texture->memory_bytes();
    return bytes;
}

}  // namespace mote
