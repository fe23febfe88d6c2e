#include "app/info_image.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <type_traits>
#include <variant>

#include <fmt/format.h>

#include "core/math.h"
#include "core/text.h"
#include "image/exr.h"

namespace mote {

namespace {

/// Smallest, largest and mean finite value of a channel.
struct ChannelRange {
    float min = infinity;
    float max = -infinity;
    double sum = 0.0;
    int64_t finite = 0;
    int64_t non_finite = 0;
};

ChannelRange range_of(const Channel& channel)
{
    ChannelRange range;
    for (const float value : channel.data) {
        if (!std::isfinite(value)) {
            ++range.non_finite;
            continue;
        }
        range.min = std::min(range.min, value);
        range.max = std::max(range.max, value);
        range.sum += static_cast<double>(value);
        ++range.finite;
    }
    return range;
}

std::string line_of(const Channel& channel)
{
    const ChannelRange r = range_of(channel);
    const std::string values = r.finite == 0
                                   ? std::string("no finite value")
                                   : fmt::format("{:>12.6g} .. {:<12.6g} mean {:.6g}", r.min, r.max,
                                                 r.sum / static_cast<double>(r.finite));
    return fmt::format("  {:<22} {:<5} {}{}\n", printable(channel.name, 60),
                       channel.type == PixelType::Half ? "half" : "float", values,
                       r.non_finite > 0 ? fmt::format(", {} not finite", r.non_finite) : "");
}

std::string layer_of(const std::string& channel)
{
    const size_t dot = channel.rfind('.');
    return dot == std::string::npos ? std::string() : channel.substr(0, dot);
}

std::string value_text(const Attribute& attribute)
{
    return std::visit(
        [](const auto& value) -> std::string {
            using T = std::decay_t<decltype(value)>;
            if constexpr (std::is_same_v<T, std::string>) {
                return fmt::format("\"{}\"", printable(value));
            } else if constexpr (std::is_same_v<T, Attribute::Rational>) {
                return fmt::format("{}/{}", value.numerator, value.denominator);
            } else if constexpr (std::is_same_v<T, std::vector<float>>) {
                const size_t shown = std::min<size_t>(value.size(), 16);
                return fmt::format(
                    "[{:g}]{}",
                    fmt::join(value.begin(), value.begin() + static_cast<std::ptrdiff_t>(shown),
                              ", "),
                    shown < value.size() ? " ..." : "");
            } else {
                return fmt::format("{}", value);
            }
        },
        attribute.value);
}

}  // namespace

std::string describe_image(const std::string& path)
{
    const LayeredImage image = read_exr(path);
    std::map<std::string, int> layers;
    for (const Channel& channel : image.channels) ++layers[layer_of(channel.name)];
    std::string text =
        fmt::format("{}: OpenEXR image, {}x{}, {} channels in {} layers\n", printable(path),
                    image.width, image.height, image.channels.size(), layers.size());
    text += "channels:\n";
    for (const Channel& channel : image.channels) text += line_of(channel);
    text += "metadata:\n";
    for (const Attribute& attribute : image.attributes) {
        text += fmt::format("  {:<22} {}\n", printable(attribute.name, 60), value_text(attribute));
    }
    return text;
}

}  // namespace mote
