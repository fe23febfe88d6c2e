#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include "app/commands.h"
#include "app/compare_report.h"
#include "app/compare_threshold.h"
#include "app/text_file.h"
#include "core/error.h"
#include "core/file_name.h"
#include "core/text.h"
#include "image/exr.h"
#include "image/png.h"
#include "verify/compare_images.h"
#include "verify/difference_image.h"

namespace mote {

namespace {

/// The channels R, G and B of a PNG, linear.
LayeredImage layers_of_png(const std::string& path)
{
    const Buffer2D<Spectrum> pixels = read_png(path);
    LayeredImage image;
    image.width = pixels.width();
    image.height = pixels.height();
    for (int c = 0; c < 3; ++c) {
        Buffer2D<float> data(image.width, image.height);
        std::transform(pixels.begin(), pixels.end(), data.begin(),
                       [c](const Spectrum& pixel) { return pixel[c]; });
        image.channels.push_back({std::string(1, "RGB"[c]), PixelType::Float, std::move(data)});
    }
    return image;
}

LayeredImage read_layers(const std::string& path)
{
    return lower_extension(path) == ".png" ? layers_of_png(path) : read_exr(path);
}

void check_difference_name(const std::string& path)
{
    const std::string extension = lower_extension(path);
    if (path.empty() || extension == ".exr" || extension == ".png") return;
    throw Error(ExitCode::Usage, fmt::format("--diff \"{}\": the name must end in .exr or .png",
                                             printable(path, 1000)));
}

/// Relative difference shown in full colour: twice the typical one, or anything if there is none.
double full_scale_of(const LayerMetrics& layer)
{
    const double scale = 2.0 * std::sqrt(layer.rel_mse_trimmed);
    return std::isfinite(scale) && scale > 0.0 ? scale : 1.0;
}

/// Returns the line that explains the picture.
std::string write_difference(const std::string& path, const LayeredImage& tested,
                             const LayeredImage& reference, const std::vector<LayerMetrics>& layers)
{
    if (lower_extension(path) == ".exr") {
        write_exr(path, difference_image(tested, reference, layers), ExrCompression::Zip);
        return fmt::format("\n{}: A - B\n", printable(path, 1000));
    }
    const LayerMetrics& layer = layers.front();
    const double full_scale = full_scale_of(layer);
    write_png(path, false_colour(tested, reference, layer, full_scale),
              {0.0f, ViewTransform::Srgb});
    return fmt::format(
        "\n{}: {}, red where A is brighter, blue where B is, full colour at +-{:.3g} %\n",
        printable(path, 1000), printable(layer.name), 100.0 * full_scale);
}

}  // namespace

void run_compare(const CompareOptions& options)
{
    std::vector<Threshold> thresholds;
    for (const std::string& text : options.thresholds) thresholds.push_back(parse_threshold(text));
    check_difference_name(options.difference);
    const LayeredImage tested = read_layers(options.tested);
    const LayeredImage reference = read_layers(options.reference);
    const NamedImage named_tested{tested, options.tested};
    const NamedImage named_reference{reference, options.reference};
    const std::vector<LayerMetrics> layers =
        compare_images(named_tested, named_reference, split_list(options.layers), {});
    const std::vector<std::string> violations = find_violations(thresholds, layers);
    const CompareReport report{named_tested, named_reference, layers, options.thresholds,
                               violations};
    fmt::print("{}", compare_table(report));
    if (!options.difference.empty()) {
        fmt::print("{}", write_difference(options.difference, tested, reference, layers));
    }
    if (!options.json.empty()) write_text_file(options.json, compare_json(report));
    if (!violations.empty()) {
        throw Error(ExitCode::BiasFound,
                    fmt::format("over the threshold: {}", fmt::join(violations, "; ")));
    }
}

}  // namespace mote
