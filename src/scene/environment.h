#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/buffer2d.h"
#include "core/distribution.h"
#include "core/rng.h"
#include "scene/light.h"

namespace mote {

/// Latitude-longitude image with what is needed to sample it. Row 0 is straight up (+y), the
/// image's centre looks along -z with +x to its right; bilinear between pixel centres, wrapped
/// around horizontally.
struct EnvironmentMap {
    Buffer2D<Spectrum> pixels;
    AliasTable table;  ///< over pixels: luminance of the reconstruction times solid angle
};

/// Image -> environment. Negative and non-finite pixels count as black and are reported once on
/// the log; an image without pixels throws Error(Input). `name` is for the messages. Black images
/// are fine: they give no light.
[[nodiscard]] std::shared_ptr<const EnvironmentMap> make_environment_map(Buffer2D<Spectrum> pixels,
                                                                         const std::string& name);

/// Radiance [W/(m^2 sr)] arriving from world direction wi [unit]. An image is black towards a wi
/// that is not finite.
[[nodiscard]] Spectrum environment_radiance(const EnvironmentLight& light, Vec3 wi);

/// Samples a direction: uniformly for a constant, else in proportion to the image's luminance.
/// Empty if the environment is black.
[[nodiscard]] std::optional<LightSample> sample_environment(const EnvironmentLight& light,
                                                            Rng& rng);

/// Density [1/sr] of sample_environment.
[[nodiscard]] float environment_pdf(const EnvironmentLight& light, Vec3 wi);

/// World direction of a point of the image: column in pixels, [0, width], and the cosine of the
/// angle from straight up.
[[nodiscard]] Vec3 environment_direction(const EnvironmentLight& light, float column,
                                         float cos_theta);

/// Cosine of the angle from straight up at the upper edge of a row of pixels.
[[nodiscard]] float environment_row_edge(int row, int height);

/// Solid angle of a pixel of a row [sr].
[[nodiscard]] float environment_pixel_size(int row, int width, int height);

/// Integral of the luminance over all directions [W/m^2]; 0 for a black environment.
[[nodiscard]] float environment_fluence(const EnvironmentLight& light);

}  // namespace mote
