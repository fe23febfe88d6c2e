#include "scene/environment.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "core/error.h"
#include "core/sampling.h"
#include "core/text.h"

namespace mote {
namespace {

int wrap(int x, int width)
{
    return x < 0 ? x + width : (x >= width ? x - width : x);
}

/// Position on the image in pixels: x in [0, width), y in [0, height).
Vec2 image_position(const EnvironmentMap& map, Vec3 d)
{
    const float u = 0.5f + 0.5f * inv_pi * std::atan2(d.x, -d.z);
    const float v = inv_pi * std::acos(std::clamp(d.y, -1.0f, 1.0f));
    return {u * static_cast<float>(map.pixels.width()),
            v * static_cast<float>(map.pixels.height())};
}

Spectrum bilinear(const Buffer2D<Spectrum>& pixels, Vec2 position)
{
    const float x = position.x - 0.5f;
    const float y = std::clamp(position.y - 0.5f, 0.0f, static_cast<float>(pixels.height() - 1));
    const float x_floor = std::floor(x);
    const float fx = x - x_floor;
    const int y0 = static_cast<int>(y);
    const int y1 = std::min(y0 + 1, pixels.height() - 1);
    const float fy = y - static_cast<float>(y0);
    const int x0 = wrap(static_cast<int>(x_floor), pixels.width());
    const int x1 = wrap(x0 + 1, pixels.width());
    const Spectrum upper = pixels.at(x0, y0) + fx * (pixels.at(x1, y0) - pixels.at(x0, y0));
    const Spectrum lower = pixels.at(x0, y1) + fx * (pixels.at(x1, y1) - pixels.at(x0, y1));
    return upper + fy * (lower - upper);
}

/// Mean luminance of the bilinear reconstruction over a pixel: (1 6 1)/8 in both directions. It is
/// positive wherever the reconstruction is, so sampling by it misses nothing.
float mean_luminance(const Buffer2D<Spectrum>& pixels, int x, int y)
{
    float sum = 0.0f;
    for (int dy = -1; dy <= 1; ++dy) {
        const int row = std::clamp(y + dy, 0, pixels.height() - 1);
        for (int dx = -1; dx <= 1; ++dx) {
            const float weight = (dx == 0 ? 0.75f : 0.125f) * (dy == 0 ? 0.75f : 0.125f);
            sum += weight * luminance(pixels.at(wrap(x + dx, pixels.width()), row));
        }
    }
    return sum;
}

}  // namespace

std::shared_ptr<const EnvironmentMap> make_environment_map(Buffer2D<Spectrum> pixels,
                                                           const std::string& name)
{
    if (pixels.width() < 1 || pixels.height() < 1) {
        throw Error(ExitCode::Input,
                    fmt::format("{}: the environment image has no pixels", printable(name)));
    }
    size_t bad_pixels = 0;
    for (Spectrum& pixel : pixels) {
        // The limit keeps sums over the image finite.
        const bool good = is_finite(pixel) && std::min({pixel.x, pixel.y, pixel.z}) >= 0.0f &&
                          max_component(pixel) <= 1e25f;
        if (good) continue;
        pixel = Spectrum(0.0f);
        ++bad_pixels;
    }
    if (bad_pixels > 0) {
        spdlog::warn("{}: {} of {} pixels are negative or not finite and count as black",
                     printable(name), bad_pixels, pixels.size());
    }
    std::vector<float> weights(pixels.size());
    size_t i = 0;
    for (int y = 0; y < pixels.height(); ++y) {
        const float solid_angle = environment_pixel_size(y, pixels.width(), pixels.height());
        for (int x = 0; x < pixels.width(); ++x) {
            weights[i++] = mean_luminance(pixels, x, y) * solid_angle;
        }
    }
    auto map = std::make_shared<EnvironmentMap>();
    map->pixels = std::move(pixels);
    map->table = AliasTable(weights);
    return map;
}

Spectrum environment_radiance(const EnvironmentLight& light, Vec3 wi)
{
    if (!light.map) return light.radiance;
    if (!is_finite(wi)) return Spectrum(0.0f);
    const Vec2 position = image_position(*light.map, light.map_from_world * wi);
    return light.radiance * bilinear(light.map->pixels, position);
}

std::optional<LightSample> sample_environment(const EnvironmentLight& light, Rng& rng)
{
    if (max_component(light.radiance) <= 0.0f) return std::nullopt;
    LightSample sample;
    sample.distance = infinity;
    if (!light.map) {
        sample.wi = sample_sphere(rng.uniform2());
        sample.Li = light.radiance;
        sample.pdf_dir = sample_sphere_pdf();
        return sample;
    }
    const EnvironmentMap& map = *light.map;
    if (map.table.is_empty()) return std::nullopt;
    const int width = map.pixels.width();
    const int height = map.pixels.height();
    const AliasTable::Sample choice = map.table.sample(uniform_double(rng));
    const int x = static_cast<int>(choice.index % static_cast<size_t>(width));
    const int y = static_cast<int>(choice.index / static_cast<size_t>(width));
    // Uniform in solid angle inside the pixel.
    const Vec2 u = rng.uniform2();
    const float upper = environment_row_edge(y, height);
    const float cos_theta = upper + u.y * (environment_row_edge(y + 1, height) - upper);
    sample.wi = environment_direction(light, static_cast<float>(x) + u.x, cos_theta);
    sample.Li = environment_radiance(light, sample.wi);
    sample.pdf_dir = choice.pmf / environment_pixel_size(y, width, height);
    return sample;
}

float environment_pdf(const EnvironmentLight& light, Vec3 wi)
{
    if (max_component(light.radiance) <= 0.0f) return 0.0f;
    if (!light.map) return sample_sphere_pdf();
    if (!is_finite(wi)) return 0.0f;
    const EnvironmentMap& map = *light.map;
    const int width = map.pixels.width();
    const int height = map.pixels.height();
    const Vec2 position = image_position(map, light.map_from_world * wi);
    const int x = std::clamp(static_cast<int>(position.x), 0, width - 1);
    const int y = std::clamp(static_cast<int>(position.y), 0, height - 1);
    const size_t index =
        static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
    return map.table.pmf(index) / environment_pixel_size(y, width, height);
}

float environment_row_edge(int row, int height)
{
    return static_cast<float>(std::cos(std::numbers::pi * row / height));
}

float environment_pixel_size(int row, int width, int height)
{
    const double upper = std::cos(std::numbers::pi * row / height);
    const double lower = std::cos(std::numbers::pi * (row + 1) / height);
    return static_cast<float>(2.0 * std::numbers::pi / width * (upper - lower));
}

Vec3 environment_direction(const EnvironmentLight& light, float column, float cos_theta)
{
    const float sin_theta = std::sqrt(std::max(0.0f, 1.0f - cos_theta * cos_theta));
    const float phi = 2.0f * pi * (column / static_cast<float>(light.map->pixels.width()) - 0.5f);
    const Vec3 d(sin_theta * std::sin(phi), cos_theta, -sin_theta * std::cos(phi));
    return d * light.map_from_world;  // a rotation: its inverse is its transpose
}

float environment_fluence(const EnvironmentLight& light)
{
    const float constant = luminance(light.radiance);
    if (!light.map) return 4.0f * pi * constant;
    return static_cast<float>(light.map->table.sum()) * constant;
}

}  // namespace mote
