#include "verify/difference_image.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace mote {

namespace {

/// Signed relative difference of one pixel of a channel.
double relative_difference(float tested, float reference, double epsilon)
{
    if (tested == reference) return 0.0;
    const auto level = static_cast<double>(reference);
    // Without epsilon the whole reference is black and every difference infinite.
    return (static_cast<double>(tested) - level) / std::sqrt(level * level + epsilon);
}

}  // namespace

Spectrum signed_colour(double value, double full_scale)
{
    if (!std::isfinite(value)) return {0.0f, 0.5f, 0.0f};
    if (value == 0.0) return Spectrum(1.0f);
    const auto faded = static_cast<float>(std::max(1.0 - std::abs(value) / full_scale, 0.0));
    return value > 0.0 ? Spectrum(1.0f, faded, faded) : Spectrum(faded, faded, 1.0f);
}

LayeredImage difference_image(const LayeredImage& tested, const LayeredImage& reference,
                              std::span<const LayerMetrics> layers)
{
    LayeredImage difference;
    difference.width = reference.width;
    difference.height = reference.height;
    for (const LayerMetrics& layer : layers) {
        for (const ChannelMetrics& channel : layer.channels) {
            const Buffer2D<float>& a = tested.find(channel.name)->data;
            const Buffer2D<float>& b = reference.find(channel.name)->data;
            Buffer2D<float> out(reference.width, reference.height);
            std::transform(a.begin(), a.end(), b.begin(), out.begin(),
                           [](float x, float y) { return x == y ? 0.0f : x - y; });
            difference.channels.push_back({channel.name, PixelType::Float, std::move(out)});
        }
    }
    return difference;
}

Buffer2D<Spectrum> false_colour(const LayeredImage& tested, const LayeredImage& reference,
                                const LayerMetrics& layer, double full_scale)
{
    MOTE_ASSERT(full_scale > 0.0 && !layer.channels.empty());
    Buffer2D<double> relative(reference.width, reference.height);
    const auto count = static_cast<double>(layer.channels.size());
    for (const ChannelMetrics& channel : layer.channels) {
        const Buffer2D<float>& a = tested.find(channel.name)->data;
        const Buffer2D<float>& b = reference.find(channel.name)->data;
        for (size_t i = 0; i < relative.size(); ++i) {
            relative.data()[i] +=
                relative_difference(a.data()[i], b.data()[i], channel.epsilon) / count;
        }
    }
    Buffer2D<Spectrum> picture(reference.width, reference.height);
    std::transform(relative.begin(), relative.end(), picture.begin(),
                   [full_scale](double r) { return signed_colour(r, full_scale); });
    return picture;
}

}  // namespace mote
