#include "study/straight_light.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/error.h"

namespace mote {

namespace {

constexpr std::string_view candidates[] = {"background", "emission", "volume_emission"};
constexpr const char* color_names[] = {"R", "G", "B"};
constexpr double most_passes = 1024.0;
/// Of the rest's time. Tests want many runs, and near the best number of passes all cost the same.
constexpr double longest_share = 1.5;

Channel& channel_of(LayeredImage& image, const std::string& name)
{
    const auto found = std::find_if(image.channels.begin(), image.channels.end(),
                                    [&](const Channel& c) { return c.name == name; });
    MOTE_ASSERT(found != image.channels.end());
    return *found;
}

const Buffer2D<float>& data_of(const LayeredImage& image, const std::string& name)
{
    const Channel* found = image.find(name);
    MOTE_ASSERT(found != nullptr);
    return found->data;
}

/// Adds factor times a part to R, G and B.
void add_part(LayeredImage& image, const LayeredImage& source, const std::string& part,
              float factor)
{
    for (const char* color : color_names) {
        Buffer2D<float>& sum = channel_of(image, color).data;
        const Buffer2D<float>& data = data_of(source, part + "." + color);
        for (size_t i = 0; i < sum.size(); ++i) sum.data()[i] += factor * data.data()[i];
    }
}

/// R, G and B alone.
LayeredImage colors_of(const LayeredImage& image)
{
    LayeredImage colors;
    colors.width = image.width;
    colors.height = image.height;
    for (const char* color : color_names) colors.channels.push_back(*image.find(color));
    return colors;
}

}  // namespace

std::vector<std::string> straight_parts(const LayeredImage& with_events,
                                        const LayeredImage& without,
                                        const std::vector<std::string>& among)
{
    std::vector<std::string> parts;
    for (const std::string& part : among) {
        if (std::find(std::begin(candidates), std::end(candidates), part) == std::end(candidates)) {
            continue;
        }
        const bool is_same =
            std::all_of(std::begin(color_names), std::end(color_names), [&](const char* color) {
                const std::string name = part + "." + color;
                const Buffer2D<float>& a = data_of(with_events, name);
                const Buffer2D<float>& b = data_of(without, name);
                return std::equal(a.begin(), a.end(), b.begin(), b.end());
            });
        if (is_same) parts.push_back(part);
    }
    return parts;
}

void replace_parts(LayeredImage& image, const LayeredImage& source,
                   const std::vector<std::string>& parts)
{
    for (const std::string& part : parts) {
        add_part(image, image, part, -1.0f);
        add_part(image, source, part, 1.0f);
        for (const char* color : color_names) {
            const std::string name = part + "." + color;
            channel_of(image, name).data = data_of(source, name);
        }
    }
}

void add_image(LayeredImage& sum, const LayeredImage& image, float factor)
{
    const bool is_first = sum.channels.empty();
    if (is_first) sum = image;
    MOTE_ASSERT(sum.channels.size() == image.channels.size());
    for (size_t c = 0; c < sum.channels.size(); ++c) {
        Buffer2D<float>& to = sum.channels[c].data;
        const Buffer2D<float>& from = image.channels[c].data;
        for (size_t i = 0; i < to.size(); ++i) {
            to.data()[i] = (is_first ? 0.0f : to.data()[i]) + factor * from.data()[i];
        }
    }
}

LayeredImage only_parts(const LayeredImage& image, const std::vector<std::string>& parts)
{
    LayeredImage sum = colors_of(image);
    for (Channel& channel : sum.channels) {
        std::fill(channel.data.begin(), channel.data.end(), 0.0f);
    }
    for (const std::string& part : parts) add_part(sum, image, part, 1.0f);
    return sum;
}

LayeredImage without_parts(const LayeredImage& image, const std::vector<std::string>& parts)
{
    LayeredImage rest = colors_of(image);
    for (const std::string& part : parts) add_part(rest, image, part, -1.0f);
    return rest;
}

int best_straight_passes(double pass_variance, double pass_seconds, double rest_variance,
                         double rest_seconds)
{
    const double ratio =
        pass_variance * rest_seconds / std::max(rest_variance * pass_seconds, 1e-300);
    const double most = std::clamp(longest_share * rest_seconds / pass_seconds, 1.0, most_passes);
    return static_cast<int>(std::lround(std::clamp(std::sqrt(ratio), 1.0, most)));
}

}  // namespace mote
