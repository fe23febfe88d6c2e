#include "restir/environment_spots.h"

#include <algorithm>
#include <cmath>

namespace mote {
namespace {

constexpr size_t most_spots = 4;
constexpr float least_share = 0.02f;      ///< of the image's light
constexpr float brightest_share = 0.02f;  ///< of the spot's peak: what is brighter belongs to it
constexpr float contrast = 8.0f;  ///< and it is this much brighter than the mean of the rest
constexpr int least_height = 60;  ///< pixels of 3 degrees: larger ones are no spots
const float cos_radius = std::cos(4.0f * pi / 180.0f);

/// An image under division. Pixels of spots lose what they have above the rest.
struct Division {
    const EnvironmentLight& whole;
    Buffer2D<Spectrum> rest;
    std::vector<bool> is_taken;  ///< by the squares of a spot

    [[nodiscard]] int width() const { return rest.width(); }
    [[nodiscard]] int height() const { return rest.height(); }
    [[nodiscard]] size_t index(int x, int y) const
    {
        return static_cast<size_t>(y) * static_cast<size_t>(width()) + static_cast<size_t>(x);
    }
    [[nodiscard]] Vec3 centre(size_t pixel) const
    {
        const auto w = static_cast<size_t>(width());
        const size_t row = pixel / w;
        const float theta = pi * (static_cast<float>(row) + 0.5f) / static_cast<float>(height());
        return environment_direction(whole, static_cast<float>(pixel % w) + 0.5f, std::cos(theta));
    }
    /// Calls f(pixel) for the pixel and its eight neighbours.
    template <class F>
    void for_neighbourhood(size_t pixel, F&& f) const
    {
        const int x = static_cast<int>(pixel % static_cast<size_t>(width()));
        const int y = static_cast<int>(pixel / static_cast<size_t>(width()));
        for (int ny = std::max(0, y - 1); ny <= std::min(height() - 1, y + 1); ++ny) {
            for (int dx = -1; dx <= 1; ++dx) f(index((x + dx + width()) % width(), ny));
        }
    }
    /// Mean luminance over the sphere, spots apart.
    [[nodiscard]] float mean() const
    {
        double sum = 0.0;
        for (size_t i = 0; i < rest.size(); ++i) {
            sum += static_cast<double>(luminance(rest.data()[i]) * size(i));
        }
        return static_cast<float>(sum) / (4.0f * pi);
    }
    [[nodiscard]] float size(size_t pixel) const
    {
        return environment_pixel_size(static_cast<int>(pixel / static_cast<size_t>(width())),
                                      width(), height());
    }
};

/// Pixels around a peak that are brighter than the threshold and hang together, near an axis.
std::vector<size_t> grow(const Division& image, size_t peak, Vec3 axis, float threshold)
{
    std::vector<size_t> found{peak};
    std::vector<bool> seen(image.rest.size(), false);
    seen[peak] = true;
    for (size_t i = 0; i < found.size(); ++i) {
        image.for_neighbourhood(found[i], [&](size_t next) {
            if (seen[next]) return;
            seen[next] = true;
            const bool belongs = !image.is_taken[next] &&
                                 luminance(image.rest.data()[next]) > threshold &&
                                 glm::dot(image.centre(next), axis) > cos_radius;
            if (belongs) found.push_back(next);
        });
    }
    return found;
}

/// Integral over a pixel's square of what the image has above the rest. Bilinear in each quadrant:
/// Gauss's rule with few points is exact to float rounding.
Spectrum integrate_square(const EnvironmentParts& parts, int x, int y)
{
    constexpr double nodes[3] = {-0.7745966692414834, 0.0, 0.7745966692414834};
    constexpr double weights[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
    const int width = parts.whole.map->pixels.width();
    const int height = parts.whole.map->pixels.height();
    Vec3d sum(0.0);
    for (int quadrant = 0; quadrant < 4; ++quadrant) {
        const int right = quadrant % 2;
        const int down = quadrant / 2;
        for (int i = 0; i < 3; ++i) {
            const double row = y + 0.5 * down + 0.25 * (1.0 + nodes[i]);
            const double theta = std::numbers::pi * row / height;
            for (int j = 0; j < 3; ++j) {
                const double column = x + 0.5 * right + 0.25 * (1.0 + nodes[j]);
                const Vec3 wi = environment_direction(parts.whole, static_cast<float>(column),
                                                      static_cast<float>(std::cos(theta)));
                const Spectrum above =
                    environment_radiance(parts.whole, wi) - environment_radiance(parts.rest, wi);
                sum += weights[i] * weights[j] * std::sin(theta) * Vec3d(above);
            }
        }
    }
    const double square = 0.25 * (std::numbers::pi / height) * (2.0 * std::numbers::pi / width);
    return Spectrum(square * sum);
}

/// Everything of a spot, once the image of the rest is known.
void finish(const EnvironmentParts& parts, EnvironmentSpot& spot)
{
    const auto width = static_cast<uint32_t>(parts.whole.map->pixels.width());
    std::vector<float> weights;
    Vec3d sum(0.0);
    for (const uint32_t pixel : spot.pixels) {
        const Spectrum part = integrate_square(parts, static_cast<int>(pixel % width),
                                               static_cast<int>(pixel / width));
        weights.push_back(luminance(part));
        sum += Vec3d(part);
    }
    // No square that shines may go without samples.
    const float most = *std::max_element(weights.begin(), weights.end());
    for (float& weight : weights) weight = std::max(weight, 1e-3f * most);
    spot.irradiance = Spectrum(sum);
    spot.table = AliasTable(weights);
}

/// Takes the brightest spot out of `image`, if it is worth that.
std::optional<EnvironmentSpot> take_spot(Division& image, double total)
{
    size_t peak = 0;
    float brightest = 0.0f;
    for (size_t i = 0; i < image.rest.size(); ++i) {
        const float own = luminance(image.rest.data()[i]);
        if (own > brightest && !image.is_taken[i]) {
            brightest = own;
            peak = i;
        }
    }
    const float threshold = std::max(brightest_share * brightest, contrast * image.mean());
    if (!(brightest > threshold)) return std::nullopt;
    EnvironmentSpot spot;
    spot.direction = image.centre(peak);
    std::vector<size_t> pixels;
    // The brightest pixel may be at the spot's rim: once more around its centre.
    for (int round = 0; round < 2; ++round) {
        pixels = grow(image, peak, spot.direction, threshold);
        double power = 0.0;
        Vec3d axis(0.0);
        for (const size_t i : pixels) {
            const float above = luminance(image.rest.data()[i]) - threshold;
            const double own = static_cast<double>(above) * static_cast<double>(image.size(i));
            power += own;
            axis += own * Vec3d(image.centre(i));
        }
        if (!(power > static_cast<double>(least_share) * total)) return std::nullopt;
        spot.direction = Vec3(glm::normalize(axis));
    }
    for (const size_t i : pixels) {
        Spectrum& pixel = image.rest.data()[i];
        pixel *= threshold / luminance(pixel);
        // Interpolation carries a pixel's light into the squares next to it.
        image.for_neighbourhood(i, [&](size_t square) {
            if (image.is_taken[square]) return;
            image.is_taken[square] = true;
            spot.pixels.push_back(static_cast<uint32_t>(square));
        });
    }
    return spot;
}

}  // namespace

EnvironmentParts split_environment(const EnvironmentLight& whole)
{
    EnvironmentParts parts{whole, whole, {}};
    if (!whole.map || whole.map->table.is_empty()) return parts;
    if (whole.map->pixels.height() < least_height) return parts;
    const double total = whole.map->table.sum();
    Division image{whole, whole.map->pixels, std::vector<bool>(whole.map->pixels.size(), false)};
    while (parts.spots.size() < most_spots) {
        std::optional<EnvironmentSpot> spot = take_spot(image, total);
        if (!spot) break;
        parts.spots.push_back(std::move(*spot));
    }
    if (parts.spots.empty()) return parts;
    parts.rest.map = make_environment_map(std::move(image.rest), "environment without its spots");
    for (EnvironmentSpot& spot : parts.spots) finish(parts, spot);
    return parts;
}

LightSample sample_spot(const EnvironmentParts& parts, const EnvironmentSpot& spot, float u_pixel,
                        Vec2 u)
{
    const int width = parts.whole.map->pixels.width();
    const int height = parts.whole.map->pixels.height();
    const AliasTable::Sample choice = spot.table.sample(static_cast<double>(u_pixel));
    const auto pixel = static_cast<int>(spot.pixels[choice.index]);
    const int row = pixel / width;
    const float upper = environment_row_edge(row, height);
    const float cos_theta = upper + u.y * (environment_row_edge(row + 1, height) - upper);
    LightSample sample;
    sample.wi =
        environment_direction(parts.whole, static_cast<float>(pixel % width) + u.x, cos_theta);
    sample.distance = infinity;
    sample.Li =
        environment_radiance(parts.whole, sample.wi) - environment_radiance(parts.rest, sample.wi);
    sample.pdf_dir = choice.pmf / environment_pixel_size(row, width, height);
    return sample;
}

}  // namespace mote
