#pragma once

#include <span>
#include <string>
#include <vector>

#include "image/layers.h"
#include "verify/metrics.h"

namespace mote {

/// Errors of the channels of one layer, and their mean over the channels.
struct LayerMetrics {
    std::string name;
    std::vector<ChannelMetrics> channels;
    double mse = 0.0;
    double rel_mse = 0.0;
    double rel_mse_trimmed = 0.0;
};

/// An image and what messages call it.
struct NamedImage {
    const LayeredImage& image;
    std::string name;
};

/// Layer of a channel: "volume" for volume.R, "rgb" for R, G and B, "alpha" for A, and the name
/// itself for others, as Z.
[[nodiscard]] std::string layer_of(const std::string& channel);

/// Layers of an image in the order of its channels, but rgb and alpha first.
[[nodiscard]] std::vector<std::string> layers_of(const LayeredImage& image);

/// Channels of a layer, colours in the order R, G, B; empty if there is no such layer.
[[nodiscard]] std::vector<const Channel*> channels_of(const LayeredImage& image,
                                                      const std::string& layer);

/// Errors of `tested` against `reference` in these layers. None named: all layers of both images
/// but `variance` and `samples`, which describe the sampling and not the picture. A channel's
/// variance is that of the layer `variance`. Throws Error(Input) if the sizes differ, or one image
/// lacks a layer, or a channel of a layer, that the other has.
[[nodiscard]] std::vector<LayerMetrics> compare_images(const NamedImage& tested,
                                                       const NamedImage& reference,
                                                       std::span<const std::string> layers,
                                                       const MetricParams& params);

}  // namespace mote
