#pragma once

#include <map>
#include <memory>
#include <string>

#include "image/stored_image.h"
#include "surfaces/texture.h"

namespace mote {

/// What a texture's numbers mean.
enum class TextureRole {
    Color,  ///< sRGB in formats that store it so (PNG)
    Data,   ///< linear in all of them
};

/// Textures kept between frames and shared by materials.
class TextureCache {
  public:
    /// The texture of an image under `version`, a text that says everything it depends on; read if
    /// it is not held. Throws Error(Input) naming the file.
    [[nodiscard]] std::shared_ptr<const Texture> get(const ImageSource& source,
                                                     const std::string& version, TextureRole role,
                                                     const TextureSampler& sampler = {});

    /// Drops the textures that nobody uses any more.
    void drop_unused();

    [[nodiscard]] size_t size() const { return held_.size(); }
    [[nodiscard]] size_t memory_bytes() const;

  private:
    std::map<std::string, std::shared_ptr<const Texture>> held_;
};

}  // namespace mote
