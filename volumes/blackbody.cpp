#include "volumes/blackbody.h"

#include <array>

namespace mote {
namespace {

constexpr double coolest = 500.0;
constexpr int steps = 512;

/// Gaussian with different widths below and above its centre.
double lobe(double x, double centre, double below, double above)
{
    const double t = (x - centre) * (x < centre ? below : above);
    return std::exp(-0.5 * t * t);
}

/// CIE 1931 matching functions at a wavelength [nm].
Vec3d matching(double nm)
{
    return {1.056 * lobe(nm, 599.8, 0.0264, 0.0323) + 0.362 * lobe(nm, 442.0, 0.0624, 0.0374) -
                0.065 * lobe(nm, 501.1, 0.0490, 0.0382),
            0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322),
            1.217 * lobe(nm, 437.0, 0.0845, 0.0278) + 0.681 * lobe(nm, 459.0, 0.0385, 0.0725)};
}

/// Spectral radiance up to a constant factor, scaled to stay finite at any temperature.
double planck(double nm, double temperature)
{
    constexpr double c2 = 1.438776877e7;  // second radiation constant [nm K]
    const double x = c2 / (nm * temperature);
    const double reference = c2 / (780.0 * temperature);
    return std::pow(nm / 780.0, -5.0) * std::expm1(reference) / std::expm1(x);
}

std::array<Spectrum, steps + 1> make_table()
{
    std::array<Spectrum, steps + 1> table;
    for (int i = 0; i <= steps; ++i) {
        const double inverse = static_cast<double>(i) / steps / coolest;
        table[static_cast<size_t>(i)] = blackbody_rgb_exact(1.0 / std::max(inverse, 1e-7));
    }
    return table;
}

}  // namespace

Spectrum blackbody_rgb_exact(double temperature)
{
    const double T = std::clamp(temperature, coolest, 1e7);
    Vec3d xyz(0.0);
    for (int nm = 380; nm <= 780; nm += 2) {
        const double wavelength = nm;
        xyz += planck(wavelength, T) * matching(wavelength);
    }
    const Vec3d rgb(3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
                    -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
                    0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z);
    const Vec3d in_gamut = glm::max(rgb, Vec3d(0.0));
    const double y = 0.2126 * in_gamut.x + 0.7152 * in_gamut.y + 0.0722 * in_gamut.z;
    return Spectrum(in_gamut / y);
}

Spectrum blackbody_rgb(float temperature)
{
    static const std::array<Spectrum, steps + 1> table = make_table();
    const float inverse = 1.0f / std::max(static_cast<float>(coolest), temperature);
    const float x = inverse * (static_cast<float>(coolest) * steps);
    const int i = std::min(static_cast<int>(x), steps - 1);
    return glm::mix(table[static_cast<size_t>(i)], table[static_cast<size_t>(i) + 1],
                    x - static_cast<float>(i));
}

}  // namespace mote
