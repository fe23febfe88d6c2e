#include "study/pictures.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "verify/difference_image.h"

namespace mote {

namespace {

constexpr const char* color_names[] = {"R", "G", "B"};

double larger_t(double a, double b)
{
    return std::abs(b) > std::abs(a) ? b : a;
}

/// Maps f(tile) over tiles that are pixels.
template <class F>
Buffer2D<Spectrum> picture_of(int width, int height, F f)
{
    Buffer2D<Spectrum> picture(width, height);
    for (size_t i = 0; i < picture.size(); ++i) picture.data()[i] = f(i);
    return picture;
}

}  // namespace

Buffer2D<Spectrum> mean_picture(const TileStats& pixels)
{
    MOTE_ASSERT(pixels.tile_size == 1);
    return picture_of(pixels.width, pixels.height, [&](size_t i) {
        Spectrum color(0.0f);
        for (int c = 0; c < 3; ++c) {
            const TileStats::ChannelStats* channel = pixels.find(color_names[c]);
            if (channel != nullptr) color[c] = static_cast<float>(channel->tiles[i].mean);
        }
        return color;
    });
}

Buffer2D<Spectrum> pixel_t_picture(const TileStats& tested, const TileStats& reference,
                                   double full_t)
{
    MOTE_ASSERT(tested.tile_size == 1 && tested.width == reference.width);
    return picture_of(tested.width, tested.height, [&](size_t i) {
        double t = 0.0;
        for (const TileStats::ChannelStats& channel : tested.channels) {
            const RunningStats& a = channel.tiles[i];
            const RunningStats& b = reference.find(channel.name)->tiles[i];
            const double error = std::sqrt(a.variance_of_mean() + b.variance_of_mean());
            if (error > 0.0) t = larger_t(t, (a.mean - b.mean) / error);
        }
        return signed_colour(t, full_t);
    });
}

Buffer2D<Spectrum> tile_t_picture(const RunComparison& comparison, double full_t)
{
    return picture_of(comparison.columns, comparison.rows, [&](size_t i) {
        double t = 0.0;
        for (const ChannelComparison& channel : comparison.channels) {
            for (const char* name : color_names) {
                if (channel.name == name) t = larger_t(t, channel.tiles[i].t);
            }
        }
        return signed_colour(t, full_t);
    });
}

Buffer2D<Spectrum> noise_picture(const TileStats& pixels)
{
    MOTE_ASSERT(pixels.tile_size == 1);
    std::vector<double> noise(static_cast<size_t>(pixels.width * pixels.height));
    for (const TileStats::ChannelStats& channel : pixels.channels) {
        for (size_t i = 0; i < noise.size(); ++i) noise[i] += channel.tiles[i].variance() / 3.0;
    }
    for (double& n : noise) n = std::sqrt(n);
    std::vector<double> sorted = noise;
    const auto top = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() * 99 / 100);
    std::nth_element(sorted.begin(), top, sorted.end());
    const double white = *top > 0.0 ? *top : 1.0;
    return picture_of(pixels.width, pixels.height, [&](size_t i) {
        return Spectrum(static_cast<float>(std::min(noise[i] / white, 1.0)));
    });
}

std::string data_uri(const Buffer2D<Spectrum>& picture, const PreviewParams& view)
{
    const std::vector<char> png = encode_png(picture, view);
    return "data:image/png;base64," + base64({png.data(), png.size()});
}

std::string base64(std::string_view bytes)
{
    constexpr const char* digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t group = 0;
        for (size_t k = 0; k < 3; ++k) {
            const auto byte =
                i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : uint32_t{0};
            group = group << 8 | byte;
        }
        for (size_t k = 0; k < 4; ++k) {
            const bool is_padding = i + k > bytes.size();
            text += is_padding ? '=' : digits[group >> (18 - 6 * k) & 63u];
        }
    }
    return text;
}

}  // namespace mote
