#include "render/film.h"

#include <utility>

namespace mote {

bool FilmSample::is_finite() const
{
    return mote::is_finite(L()) && std::isfinite(transmittance) && mote::is_finite(albedo) &&
           std::isfinite(motion.x) && std::isfinite(motion.y) && !std::isnan(optical_depth) &&
           mote::is_finite(reservoir) && mote::is_finite(normal) && mote::is_finite(position) &&
           (!collided || std::isfinite(depth));
}

Spectrum MeanSpectrum::mean(int64_t count) const
{
    return count > 0 ? Spectrum(sum / static_cast<double>(count)) : Spectrum(0.0f);
}

bool PixelFilm::add(const FilmSample& sample)
{
    if (!sample.is_finite()) {
        add(FilmSample{});
        return false;
    }
    const Spectrum L = sample.L();
    for (int c = 0; c < 3; ++c) rgb_[c].add(static_cast<double>(L[c]));
    direct_.add(sample.direct);
    indirect_.add(sample.indirect);
    emission_.add(sample.emission);
    background_.add(sample.background);
    surface_direct_.add(sample.surface_direct);
    surface_indirect_.add(sample.surface_indirect);
    surface_emission_.add(sample.surface_emission);
    if (sample.has_surface) {
        ++surfaces_;
        normal_.add(sample.normal);
        position_.add(sample.position);
        if (sample.surface_distance < nearest_surface_) {
            nearest_surface_ = sample.surface_distance;
            material_ = sample.material;
        }
    }
    const double tau = static_cast<double>(sample.optical_depth);
    transmittance_ += static_cast<double>(sample.transmittance);
    exact_transmittance_ += std::exp(-tau);
    optical_depth_ += tau;
    reservoir_.add(sample.reservoir);
    work_.add(sample.work);
    exact_rays_ += static_cast<double>(sample.exact_rays);
    if (sample.collided) {
        ++collisions_;
        albedo_.add(sample.albedo);
        if (!sample.on_surface) {
            ++in_smoke_;
            depth_ += static_cast<double>(sample.depth);
        }
        nearest_ = std::min(nearest_, sample.depth);
        collision_motion_ += glm::dvec2(sample.motion);
    } else {
        background_motion_ += glm::dvec2(sample.motion);
    }
    return true;
}

Spectrum PixelFilm::mean() const
{
    return {static_cast<float>(rgb_[0].mean), static_cast<float>(rgb_[1].mean),
            static_cast<float>(rgb_[2].mean)};
}

Spectrum PixelFilm::variance_of_mean() const
{
    return {static_cast<float>(rgb_[0].variance_of_mean()),
            static_cast<float>(rgb_[1].variance_of_mean()),
            static_cast<float>(rgb_[2].variance_of_mean())};
}

float PixelFilm::alpha() const
{
    if (count() == 0) return 0.0f;
    return static_cast<float>(1.0 - transmittance_ / static_cast<double>(count()));
}

void PixelFilm::layer(Aov aov, float (&values)[3]) const
{
    const auto store = [&](Spectrum s) {
        for (int c = 0; c < 3; ++c) values[c] = s[c];
    };
    const double n = static_cast<double>(std::max<int64_t>(count(), 1));
    switch (aov) {
        case Aov::Z:
            values[0] = collisions_ > 0 ? nearest_ : background_depth;
            break;
        case Aov::VolumeZ:
            values[0] = in_smoke_ > 0 ? static_cast<float>(depth_ / static_cast<double>(in_smoke_))
                                      : background_depth;
            break;
        case Aov::Albedo:
            store(albedo_.mean(count()));
            break;
        case Aov::Motion: {
            const glm::dvec2 motion = collisions_ > 0
                                          ? collision_motion_ / static_cast<double>(collisions_)
                                          : background_motion_ / n;
            values[0] = static_cast<float>(motion.x);
            values[1] = static_cast<float>(motion.y);
            break;
        }
        case Aov::Variance:
            store(variance_of_mean());
            break;
        case Aov::Samples:
            values[0] = static_cast<float>(count());
            break;
        case Aov::VolumeDirect:
            store(direct_.mean(count()));
            break;
        case Aov::VolumeIndirect:
            store(indirect_.mean(count()));
            break;
        case Aov::VolumeEmission:
            store(emission_.mean(count()));
            break;
        case Aov::Background:
            store(background_.mean(count()));
            break;
        case Aov::Transmittance:
            store(Spectrum(static_cast<float>(exact_transmittance_ / n)));
            break;
        case Aov::OpticalDepth:
            values[0] = static_cast<float>(optical_depth_ / n);
            break;
        case Aov::Direct:
            store(surface_direct_.mean(count()));
            break;
        case Aov::Indirect:
            store(surface_indirect_.mean(count()));
            break;
        case Aov::Emission:
            store(surface_emission_.mean(count()));
            break;
        case Aov::Normal:
            store(normal_.mean(surfaces_));
            break;
        case Aov::Position:
            store(position_.mean(surfaces_));
            break;
        case Aov::MaterialId:
            values[0] = static_cast<float>(material_ + 1);
            break;
        case Aov::Restir:
            store(reservoir_.mean(count()));
            break;
        case Aov::Cost:
            values[0] = static_cast<float>(exact_rays_ / n);
            break;
        case Aov::Work:
            store(work_.mean(count()));
            break;
    }
}

Film::Film(int width, int height, const AovSet& aovs, PixelType color_type)
{
    image_.width = width;
    image_.height = height;
    const auto add_channel = [&](const std::string& name, PixelType type) {
        image_.channels.push_back({name, type, Buffer2D<float>(width, height)});
    };
    for (const char* name : {"R", "G", "B", "A"}) add_channel(name, color_type);
    for (const AovInfo& info : aov_table()) {
        if (!aovs.has(info.aov)) continue;
        layers_.push_back({info.aov, image_.channels.size(), info.channels.size()});
        for (const std::string& name : info.channels) {
            add_channel(name, info.always_float ? PixelType::Float : color_type);
        }
    }
}

void Film::store(int x, int y, const PixelFilm& pixel)
{
    const Spectrum rgb = pixel.mean();
    for (int c = 0; c < 3; ++c) image_.channels[static_cast<size_t>(c)].data.at(x, y) = rgb[c];
    image_.channels[3].data.at(x, y) = pixel.alpha();
    for (const Layer& layer : layers_) {
        float values[3] = {};
        pixel.layer(layer.aov, values);
        for (size_t c = 0; c < layer.channel_count; ++c) {
            image_.channels[layer.first_channel + c].data.at(x, y) = values[c];
        }
    }
}

}  // namespace mote
