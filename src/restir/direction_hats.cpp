#include "restir/direction_hats.h"

#include "core/parallel.h"
#include "scene/environment.h"

namespace mote {

Vec3 DirectionHats::centre(int k) const
{
    const int band = k / azimuths;
    const float u = (static_cast<float>(band) + 0.5f) / static_cast<float>(bands);
    const float v = (static_cast<float>(k % azimuths) + 0.5f) / static_cast<float>(azimuths);
    const float y = 1.0f - 2.0f * u;
    const float r = std::sqrt(1.0f - y * y);
    return {r * std::sin(2.0f * pi * v), y, r * std::cos(2.0f * pi * v)};
}

DirectionHats::Weights DirectionHats::at(Vec3 wi) const
{
    return at_square(0.5f - 0.5f * wi.y, std::atan2(wi.x, wi.z) * (0.5f * inv_pi));
}

DirectionHats::Weights DirectionHats::at_square(float u, float v) const
{
    const auto turn = static_cast<float>(azimuths);
    // Not-a-number becomes 0 in the clamps.
    const float band = std::min(std::max(0.0f, u * static_cast<float>(bands) - 0.5f),
                                static_cast<float>(bands - 1));
    const float azimuth = std::min(std::max(0.0f, (v + 2.0f) * turn - 0.5f), 4.0f * turn);
    const int i = std::min(static_cast<int>(band), std::max(bands - 2, 0));
    const int j = static_cast<int>(azimuth);
    const float fu = band - static_cast<float>(i);
    const float fv = azimuth - static_cast<float>(j);
    const int row0 = i * azimuths;
    const int row1 = std::min(i + 1, bands - 1) * azimuths;
    const int column0 = j % azimuths;
    const int column1 = (j + 1) % azimuths;
    return {{row0 + column0, row0 + column1, row1 + column0, row1 + column1},
            {(1.0f - fu) * (1.0f - fv), (1.0f - fu) * fv, fu * (1.0f - fv), fu * fv}};
}

std::vector<Spectrum> mean_radiance(const EnvironmentLight& environment, const DirectionHats& hats)
{
    const auto count = static_cast<size_t>(hats.count());
    if (!environment.map) return std::vector<Spectrum>(count, environment.radiance);
    // A grid over the image with whole samples per pixel: between pixel centres the image is
    // smooth, and so are hats over few pixels.
    const int width = environment.map->pixels.width();
    const int height = environment.map->pixels.height();
    const int columns = width * std::max(1, 512 / width);
    const int rows = height * std::max(1, 256 / height);
    struct Sum {
        Vec3d radiance{0.0};
        double weight = 0.0;
    };
    std::vector<Sum> sums(static_cast<size_t>(rows) * count);
    parallel_for(static_cast<size_t>(rows), 1, [&](size_t begin, size_t end) {
        for (size_t row = begin; row < end; ++row) {
            Sum* sum = sums.data() + row * count;
            const double theta = std::numbers::pi * (static_cast<double>(row) + 0.5) / rows;
            for (int x = 0; x < columns; ++x) {
                const double phi = 2.0 * std::numbers::pi * (x + 0.5) / columns;
                const Vec3 d(Vec3d(std::sin(theta) * std::sin(phi), std::cos(theta),
                                   std::sin(theta) * std::cos(phi)));
                // A rotation: its inverse is its transpose.
                const Vec3 wi = d * environment.map_from_world;
                const Vec3d radiance(environment_radiance(environment, wi));
                const DirectionHats::Weights hat = hats.at(wi);
                for (int e = 0; e < 4; ++e) {
                    Sum& s = sum[hat.index[e]];
                    const double weight = std::sin(theta) * static_cast<double>(hat.weight[e]);
                    s.radiance += weight * radiance;
                    s.weight += weight;
                }
            }
        }
    });
    std::vector<Spectrum> out;
    for (size_t k = 0; k < count; ++k) {
        Sum total;
        for (size_t row = 0; row < static_cast<size_t>(rows); ++row) {
            total.radiance += sums[row * count + k].radiance;
            total.weight += sums[row * count + k].weight;
        }
        out.emplace_back(total.weight > 0.0 ? total.radiance / total.weight : Vec3d(0.0));
    }
    return out;
}

}  // namespace mote
