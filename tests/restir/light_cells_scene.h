#pragma once

#include <vector>

#include "core/sampling.h"
#include "restir/light_cells.h"
#include "support/media.h"

namespace mote::test {

/// Lamps of all kinds in and around a cube of edge 2; every seventh has no power.
inline std::vector<Light> mixed_lamps(int count)
{
    std::vector<Light> lamps;
    for (int i = 0; i < count; ++i) {
        Rng rng(1, 0, Stream::Test, static_cast<uint32_t>(i), 0);
        const Vec3 p = 3.0f * rng.uniform3() - 1.5f;
        const Spectrum color = i % 7 == 3 ? Spectrum(0.0f) : rng.uniform3();
        switch (i % 4) {
            case 0:
                lamps.push_back(SphereLight{p, 0.02f + 0.1f * rng.uniform(), color});
                break;
            case 1:
                lamps.push_back(QuadLight{p, 0.2f * rng.uniform3(), 0.2f * rng.uniform3() - 0.1f,
                                          color, false});
                break;
            case 2:
                lamps.push_back(DistantLight{sample_sphere(rng.uniform2()), color});
                break;
            default:
                lamps.push_back(PointLight{p, color});
        }
    }
    return lamps;
}

/// Lights of equal kind at random places in a cube of edge 2.
inline std::vector<LocalLight> random_lights(int count)
{
    std::vector<LocalLight> lights;
    for (int i = 0; i < count; ++i) {
        Rng rng(2, 0, Stream::Test, static_cast<uint32_t>(i), 0);
        LocalLight light;
        light.id = i;
        light.position = 2.0f * rng.uniform3() - 1.0f;
        light.power = 0.1f + rng.uniform();
        lights.push_back(light);
    }
    return lights;
}

/// Clumpy smoke of optical depth about 5 through the middle.
inline Media clumpy_media()
{
    Volume volume = clumpy_cube(48);
    volume.density_scale = 8.0f;
    volume.phase.g = 0.5f;
    finalize(volume);
    return {{volume}};
}

/// Points in the smoke, in its margin, and far away.
inline Vec3 some_point(uint32_t k)
{
    Rng rng(3, 0, Stream::Test, k, 0);
    const float edge = k % 3 == 0 ? 20.0f : 2.4f;
    return edge * (rng.uniform3() - 0.5f);
}

inline constexpr Vec3 test_eye{0.0f, 0.5f, 6.0f};

/// Sum of the probabilities of lights 0..count-1.
inline double pmf_sum(const LightCells& cells, int count, Vec3 x)
{
    double sum = 0.0;
    for (int i = 0; i < count; ++i) sum += static_cast<double>(cells.pmf(i, x));
    return sum;
}

}  // namespace mote::test
