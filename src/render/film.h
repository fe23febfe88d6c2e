#pragma once

#include <cstdint>
#include <span>

#include "core/buffer2d.h"
#include "core/math.h"
#include "core/stats.h"
#include "image/layers.h"
#include "render/aov.h"

namespace mote {

/// What one camera path brings to a pixel, for the layers that were asked for.
struct FilmSample {
    float weight = 1.0f;  ///< share of the pixel's pass that it stands for, (0,1]
    Spectrum direct{0.0f};
    Spectrum indirect{0.0f};
    Spectrum emission{0.0f};
    Spectrum background{0.0f};
    Spectrum surface_direct{0.0f};
    Spectrum surface_indirect{0.0f};
    Spectrum surface_emission{0.0f};
    float transmittance = 1.0f;  ///< unbiased estimate, for alpha
    bool collided = false;       ///< whether depth and albedo mean something
    bool on_surface = false;     ///< whether a surface was there before any collision
    bool has_surface = false;    ///< whether normal and position mean something
    float depth = infinity;      ///< of the first collision or surface, along the view axis [m]
    Vec3 normal{0.0f};           ///< of the first surface, towards the camera [unit]
    Vec3 position{0.0f};         ///< of the first surface [m]
    float surface_distance = infinity;  ///< of the first surface, along the ray [m]
    int material = -1;                  ///< of the first surface, into Surfaces::materials
    Spectrum albedo{0.0f};
    Vec2 motion{0.0f};           ///< [px], v up
    float optical_depth = 0.0f;  ///< in closed form, where a layer needs it
    Vec3 reservoir{0.0f};        ///< M, W, age
    float exact_rays = 0.0f;     ///< towards camera and lights
    Vec3 work{0.0f};             ///< candidates, cells of the camera ray, acceptance of reuse

    [[nodiscard]] Spectrum L() const
    {
        return direct + indirect + emission + background + surface_direct + surface_indirect +
               surface_emission;
    }
    [[nodiscard]] bool is_finite() const;
};

/// Mean of three channels, in double.
struct MeanSpectrum {
    glm::dvec3 sum{0.0};

    void add(Spectrum s, double weight = 1.0) { sum += weight * glm::dvec3(s); }
    [[nodiscard]] Spectrum mean(double count) const;
};

/// All samples of one pixel. The pixel filter is the pixel's square (a box of width 1), sampled
/// uniformly: every sample belongs to one pixel, so pixels are independent, the mean is the
/// radiance averaged over the square, and data layers are not filtered any other way.
class PixelFilm {
  public:
    /// Adds a sample; one with a value that is not finite counts as black and gives false.
    bool add(const FilmSample& sample) { return add(std::span<const FilmSample>(&sample, 1)); }
    /// Adds one of several parts, whose weights sum to 1; work counts as done for each.
    bool add(std::span<const FilmSample> parts);

    [[nodiscard]] int64_t count() const { return rgb_[0].count; }
    [[nodiscard]] Spectrum mean() const;
    [[nodiscard]] Spectrum variance_of_mean() const;  ///< Welford's M2 / (n (n - 1))
    [[nodiscard]] float alpha() const;                ///< 1 - mean transmittance
    /// Values of a layer, as many as it has channels.
    void layer(Aov aov, float (&values)[3]) const;

  private:
    void add_part(const FilmSample& part);

    RunningStats rgb_[3];
    MeanSpectrum direct_, indirect_, emission_, background_, albedo_, reservoir_, work_;
    MeanSpectrum surface_direct_, surface_indirect_, surface_emission_, normal_, position_;
    double transmittance_ = 0.0;
    double exact_transmittance_ = 0.0;
    double optical_depth_ = 0.0;
    double exact_rays_ = 0.0;
    double depth_ = 0.0;
    float nearest_ = infinity;
    float nearest_surface_ = infinity;
    int material_ = -1;        ///< of the sample with that surface
    double collisions_ = 0.0;  ///< samples that met smoke or a surface
    double in_smoke_ = 0.0;    ///< those of them in smoke, of which depth_ is
    double surfaces_ = 0.0;    ///< samples with a surface, smoke in front or not
    glm::dvec2 collision_motion_{0.0};
    glm::dvec2 background_motion_{0.0};
};

/// The frame's image being filled: R, G, B, A and the channels of the layers asked for.
class Film {
  public:
    Film(int width, int height, const AovSet& aovs, PixelType color_type);

    void store(int x, int y, const PixelFilm& pixel);
    [[nodiscard]] LayeredImage take() { return std::move(image_); }

  private:
    struct Layer {
        Aov aov;
        size_t first_channel;
        size_t channel_count;
    };
    std::vector<Layer> layers_;
    LayeredImage image_;
};

}  // namespace mote
