#pragma once

#include "core/buffer2d.h"
#include "core/math.h"
#include "image/layers.h"

namespace mote {

/// The channels R, G, B of an image; 0 for those it lacks.
[[nodiscard]] inline Buffer2D<Spectrum> color_of(const LayeredImage& image)
{
    Buffer2D<Spectrum> color(image.width, image.height);
    const Channel* channels[] = {image.find("R"), image.find("G"), image.find("B")};
    for (int c = 0; c < 3; ++c) {
        if (channels[c] == nullptr) continue;
        const float* from = channels[c]->data.data();
        for (Spectrum& pixel : color) pixel[c] = *from++;
    }
    return color;
}

}  // namespace mote
