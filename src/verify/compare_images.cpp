#include "verify/compare_images.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"

namespace mote {

namespace {

bool contains(std::span<const std::string> names, const std::string& name)
{
    return std::find(names.begin(), names.end(), name) != names.end();
}

std::string joined(std::span<const std::string> names)
{
    return printable(fmt::format("{}", fmt::join(names, ",")), 1000);
}

[[noreturn]] void refuse(const std::string& message)
{
    throw Error(ExitCode::Input, message);
}

void check_sizes(const NamedImage& tested, const NamedImage& reference)
{
    const LayeredImage& a = tested.image;
    const LayeredImage& b = reference.image;
    if (a.width == b.width && a.height == b.height) return;
    refuse(fmt::format("{} has {} x {} pixels but {} has {} x {}; render both at the same size",
                       printable(tested.name), a.width, a.height, printable(reference.name),
                       b.width, b.height));
}

void check_has_layer(const NamedImage& image, const std::string& layer)
{
    const std::vector<std::string> present = layers_of(image.image);
    if (contains(present, layer)) return;
    refuse(fmt::format("{} has no layer \"{}\"{}; its layers are {}", printable(image.name),
                       printable(layer), did_you_mean(layer, present), joined(present)));
}

/// The layers of one image that describe the picture, not the sampling.
std::vector<std::string> picture_layers(const LayeredImage& image)
{
    std::vector<std::string> layers = layers_of(image);
    layers.erase(std::remove_if(layers.begin(), layers.end(),
                                [](const std::string& layer) {
                                    return layer == "variance" || layer == "samples";
                                }),
                 layers.end());
    return layers;
}

void check_has_all(const NamedImage& image, const NamedImage& other)
{
    const std::vector<std::string> present = picture_layers(image.image);
    std::vector<std::string> common;
    std::vector<std::string> missing;
    for (const std::string& layer : picture_layers(other.image)) {
        (contains(present, layer) ? common : missing).push_back(layer);
    }
    if (missing.empty()) return;
    refuse(fmt::format("{} lacks layers that {} has: {}; {}", printable(image.name),
                       printable(other.name), joined(missing),
                       common.empty() ? "they have none in common"
                                      : "compare those of both with --layers " + joined(common)));
}

void check_has_channels(const NamedImage& image, const NamedImage& other, const std::string& layer)
{
    for (const Channel* channel : channels_of(other.image, layer)) {
        if (image.image.find(channel->name) != nullptr) continue;
        refuse(fmt::format("{} has no channel \"{}\", which {} has", printable(image.name),
                           printable(channel->name), printable(other.name)));
    }
}

LayerMetrics compare_layer(const LayeredImage& tested, const LayeredImage& reference,
                           const std::string& layer, const MetricParams& params)
{
    LayerMetrics metrics;
    metrics.name = layer;
    for (const Channel* channel : channels_of(reference, layer)) {
        const std::string variance = "variance." + channel->name;
        metrics.channels.push_back(
            measure_channel({*tested.find(channel->name), *channel, tested.find(variance),
                             reference.find(variance)},
                            params));
    }
    const auto count = static_cast<double>(metrics.channels.size());
    for (const ChannelMetrics& channel : metrics.channels) {
        metrics.mse += channel.mse / count;
        metrics.rel_mse += channel.rel_mse / count;
        metrics.rel_mse_trimmed += channel.rel_mse_trimmed / count;
    }
    return metrics;
}

/// Colours in their usual order instead of OpenEXR's alphabetical one.
int channel_rank(const std::string& channel)
{
    const size_t dot = channel.rfind('.');
    const std::string component = dot == std::string::npos ? channel : channel.substr(dot + 1);
    if (component == "R") return 0;
    if (component == "G") return 1;
    return component == "B" ? 2 : 3;
}

int layer_rank(const std::string& layer)
{
    if (layer == "rgb") return 0;
    return layer == "alpha" ? 1 : 2;
}

}  // namespace

std::string layer_of(const std::string& channel)
{
    const size_t dot = channel.rfind('.');
    if (dot != std::string::npos) return channel.substr(0, dot);
    if (channel == "R" || channel == "G" || channel == "B") return "rgb";
    return channel == "A" ? "alpha" : channel;
}

std::vector<std::string> layers_of(const LayeredImage& image)
{
    std::vector<std::string> layers;
    for (const Channel& channel : image.channels) {
        std::string layer = layer_of(channel.name);
        if (!contains(layers, layer)) layers.push_back(std::move(layer));
    }
    std::stable_sort(layers.begin(), layers.end(), [](const std::string& a, const std::string& b) {
        return layer_rank(a) < layer_rank(b);
    });
    return layers;
}

std::vector<const Channel*> channels_of(const LayeredImage& image, const std::string& layer)
{
    std::vector<const Channel*> channels;
    for (const Channel& channel : image.channels) {
        if (layer_of(channel.name) == layer) channels.push_back(&channel);
    }
    std::stable_sort(channels.begin(), channels.end(), [](const Channel* a, const Channel* b) {
        return channel_rank(a->name) < channel_rank(b->name);
    });
    return channels;
}

std::vector<LayerMetrics> compare_images(const NamedImage& tested, const NamedImage& reference,
                                         std::span<const std::string> layers,
                                         const MetricParams& params)
{
    check_sizes(tested, reference);
    std::vector<std::string> chosen(layers.begin(), layers.end());
    if (chosen.empty()) {
        check_has_all(tested, reference);
        check_has_all(reference, tested);
        chosen = picture_layers(reference.image);
    }
    std::vector<LayerMetrics> metrics;
    for (const std::string& layer : chosen) {
        check_has_layer(tested, layer);
        check_has_layer(reference, layer);
        check_has_channels(tested, reference, layer);
        check_has_channels(reference, tested, layer);
        metrics.push_back(compare_layer(tested.image, reference.image, layer, params));
    }
    return metrics;
}

}  // namespace mote
