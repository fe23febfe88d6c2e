#include "runs/pixel_stats.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "runs/trimmed_mean.h"

namespace mote {

namespace {

double channel_mean(const Spectrum& s)
{
    return (double{s.x} + double{s.y} + double{s.z}) / 3.0;
}

/// Per pixel, mean over the channels; empty for fewer than two runs.
std::vector<double> pixel_variances(const PixelStats& stats)
{
    std::vector<double> variances;
    if (stats.run_count < 2) return variances;
    for (const Spectrum& m2 : stats.m2) {
        variances.push_back(channel_mean(m2) / (stats.run_count - 1));
    }
    return variances;
}

}  // namespace

void add_run(PixelStats& stats, const Buffer2D<Spectrum>& image)
{
    if (stats.run_count == 0) {
        stats.mean = Buffer2D<Spectrum>(image.width(), image.height());
        stats.m2 = stats.mean;
    }
    MOTE_ASSERT(stats.mean.width() == image.width() && stats.mean.height() == image.height());
    ++stats.run_count;
    const float weight = 1.0f / static_cast<float>(stats.run_count);
    for (size_t i = 0; i < image.size(); ++i) {
        const Spectrum x = image.data()[i];
        Spectrum& mean = stats.mean.data()[i];
        const Spectrum delta = x - mean;
        mean += weight * delta;
        stats.m2.data()[i] += delta * (x - mean);
    }
    stats.image_means.add(image_mean(image));
}

Spectrum variance_of_mean(const PixelStats& stats, size_t pixel)
{
    if (stats.run_count < 2) return Spectrum(0.0f);
    const auto n = static_cast<float>(stats.run_count);
    return stats.m2.data()[pixel] / (n * (n - 1.0f));
}

double mean_variance(const PixelStats& stats)
{
    return trimmed_mean_variance(stats, 0.0);
}

double trimmed_mean_variance(const PixelStats& stats, double share)
{
    const std::vector<double> variances = pixel_variances(stats);
    return trimmed_mean(variances, worst_pixels(variances, share));
}

double image_mean(const Buffer2D<Spectrum>& image)
{
    if (image.size() == 0) return 0.0;
    double sum = 0.0;
    for (const Spectrum& pixel : image) sum += channel_mean(pixel);
    return sum / static_cast<double>(image.size());
}

int64_t replace_non_finite(Buffer2D<Spectrum>& image)
{
    int64_t count = 0;
    for (Spectrum& pixel : image) {
        if (std::isfinite(pixel.x) && std::isfinite(pixel.y) && std::isfinite(pixel.z)) continue;
        pixel = Spectrum(0.0f);
        ++count;
    }
    return count;
}

}  // namespace mote
