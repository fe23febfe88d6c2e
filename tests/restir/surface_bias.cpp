#include "restir/surface_bias.h"

#include <fmt/format.h>

namespace mote::test {
namespace {

constexpr int batches = 10;

/// One layer of an image, pixel by pixel.
std::vector<Spectrum> layer_of(const LayeredImage& image, const std::string& layer)
{
    std::vector<Spectrum> out(static_cast<size_t>(image.width) * static_cast<size_t>(image.height));
    for (const Channel& channel : image.channels) {
        for (int c = 0; c < 3; ++c) {
            if (channel.name != fmt::format("{}.{}", layer, "RGB"[c])) continue;
            for (size_t i = 0; i < out.size(); ++i) out[i][c] = channel.data.data()[i];
        }
    }
    return out;
}

Spectrum mean_of(const std::vector<Spectrum>& pixels)
{
    Spectrum sum(0.0f);
    for (const Spectrum& p : pixels) sum += p;
    return sum / static_cast<float>(pixels.size());
}

/// Sums of independent batches of runs, value by value.
using BatchSums = std::vector<std::vector<double>>;

/// Mean over values of the bias squared: products of different batches have no noise squared.
/// `left_out`: a batch that does not count.
double squared_bias(const BatchSums& means, size_t left_out)
{
    const double count = static_cast<double>(means.size()) - (left_out < means.size() ? 1.0 : 0.0);
    double total = 0.0;
    for (size_t i = 0; i < means[0].size(); ++i) {
        double sum = 0.0;
        double squares = 0.0;
        for (size_t b = 0; b < means.size(); ++b) {
            if (b == left_out) continue;
            sum += means[b][i];
            squares += means[b][i] * means[b][i];
        }
        total += (sum * sum - squares) / (count * (count - 1.0));
    }
    return total / static_cast<double>(means[0].size());
}

/// `scale`: of the sums. The error by the jackknife over batches.
SquaredBias squared_bias(const BatchSums& sums, double scale)
{
    SquaredBias out;
    out.mean = scale * scale * squared_bias(sums, sums.size());
    RunningStats jackknife;
    for (size_t b = 0; b < sums.size(); ++b) jackknife.add(scale * scale * squared_bias(sums, b));
    out.error = (static_cast<double>(sums.size()) - 1.0) * jackknife.standard_error();
    return out;
}

}  // namespace

std::string SurfaceBias::row(const std::string& name) const
{
    return fmt::format(
        "{:24} mean {:+6.2f} +- {:4.2f} %  pixels {:5.2f} % ({:+7.2f} +- {:5.2f})  colours {:5.2f} "
        "% ({:+7.2f} +- {:5.2f})  {:5.2f} rays",
        name, mean, mean_error, pixel.root(), pixel.mean, pixel.error, color.root(), color.mean,
        color.error, rays);
}

SurfaceBias measure_surface_bias(const std::vector<Scene>& frames, const FrameCaches& caches,
                                 const RestirParams& params, int runs)
{
    RenderDescription render;
    render.width = frames.front().camera.width;
    render.height = frames.front().camera.height;
    render.samples = 1;
    render.estimator = EstimatorKind::Restir;
    render.restir = params;
    const size_t first = uses_history(render) ? 0 : frames.size() - 1;
    const OutputDescription output = direct_light_output();
    const auto pixels = static_cast<size_t>(render.width) * static_cast<size_t>(render.height);
    FrameStats stats;
    const auto last_frame = [&](const RestirParams& restir, size_t from) {
        render.restir = restir;
        FrameHistory history;
        LayeredImage image;
        for (size_t i = from; i < frames.size(); ++i) {
            history.impl().caches = caches[i];
            image = render_frame(frames[i], render, output, history, nullptr, stats);
        }
        return layer_of(image, "direct");
    };
    RestirParams reusing = params;
    reusing.edge_strata = 1;  // further parts of pixels with edges reuse nothing: no bias to see
    RestirParams off = reusing;
    off.reuse = ReuseMode::Off;
    RunningStats added;
    RunningStats own;
    RunningStats rays;
    BatchSums luminances(batches, std::vector<double>(pixels));
    BatchSums colors(batches, std::vector<double>(3 * pixels));
    for (int run = 0; run < runs; ++run) {
        render.seed = 1 + static_cast<uint32_t>(run);
        const std::vector<Spectrum> reused = last_frame(reusing, first);
        rays.add(static_cast<double>(stats.tracking.surface_rays) / static_cast<double>(pixels));
        const std::vector<Spectrum> plain = last_frame(off, frames.size() - 1);
        const auto batch = static_cast<size_t>(run % batches);
        for (size_t i = 0; i < pixels; ++i) {
            const Spectrum difference = reused[i] - plain[i];
            luminances[batch][i] += static_cast<double>(luminance(difference));
            for (int c = 0; c < 3; ++c) {
                colors[batch][3 * i + static_cast<size_t>(c)] += static_cast<double>(difference[c]);
            }
        }
        own.add(static_cast<double>(luminance(mean_of(plain))));
        added.add(static_cast<double>(luminance(mean_of(reused) - mean_of(plain))));
    }
    SurfaceBias out;
    const double percent = 100.0 / own.mean;
    const double per_batch = percent * batches / runs;
    out.mean = percent * added.mean;
    out.mean_error = percent * added.standard_error();
    out.pixel = squared_bias(luminances, per_batch);
    out.color = squared_bias(colors, per_batch);
    out.rays = rays.mean;
    return out;
}

}  // namespace mote::test
