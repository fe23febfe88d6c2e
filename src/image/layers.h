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

/// Metadata entry of an image file: text, number, vector of numbers, rational. Vectors of 2 and 3
/// numbers become V2f and V3f in OpenEXR, 16 numbers a matrix (for row vectors times matrix, which
/// is the memory order of a column-major matrix for column vectors), 8 numbers named
/// "chromaticities" the standard attribute; others a float vector.
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
    [[nodiscard]] const Attribute* find_attribute(const std::string& name) const
    {
        for (const Attribute& a : attributes) {
            if (a.name == name) return &a;
        }
        return nullptr;
    }
};

}  // namespace mote
