#pragma once

#include <string>
#include <variant>
#include <vector>

#include "core/buffer2d.h"

namespace mote {

/// Storage of one image channel on disk.
enum class PixelType { Half, Float };

/// One named channel, e.g. "R" or "volume_direct.G".
struct Channel {
    std::string name;
    PixelType type = PixelType::Half;
    Buffer2D<float> data;
};

/// Metadata entry of an image file: text, number, vector of numbers (16: a matrix), rational.
struct Attribute {
    struct Rational {
        int numerator;
        unsigned denominator;
    };
    std::string name;
    std::variant<std::string, int, float, std::vector<float>, Rational> value;
};

/// A multi-layer image in memory. All channels have the same size.
struct LayeredImage {
    int width = 0;
    int height = 0;
    std::vector<Channel> channels;
    std::vector<Attribute> attributes;

    [[nodiscard]] const Channel* find(const std::string& name) const
    {
        for (const Channel& c : channels) {
            if (c.name == name) return &c;
        }
        return nullptr;
    }
};

}  // namespace mote
