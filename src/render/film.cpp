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

Spectrum MeanSpectrum::mean(double count) const
{
    return count > 0.0 ? Spectrum(sum / count) : Spectrum(0.0f);
}

bool PixelFilm::add(std::span<const FilmSample> parts)
{
    glm::dvec3 L(0.0);
    for (const FilmSample& part : parts) {
        if (!part.is_finite()) {
            add(FilmSample{});
            return false;
        }
        L += static_cast<double>(part.weight) * glm::dvec3(part.L());
    }
    for (int c = 0; c < 3; ++c) rgb_[c].add(L[c]);
    for (const FilmSample& part : parts) add_part(part);
    return true;
}

void PixelFilm::add_part(const FilmSample& part)
{
    const auto weight = static_cast<double>(part.weight);
    direct_.add(part.direct, weight);
    indirect_.add(part.indirect, weight);
    emission_.add(part.emission, weight);
    background_.add(part.background, weight);
    surface_direct_.add(part.surface_direct, weight);
    surface_indirect_.add(part.surface_indirect, weight);
    surface_emission_.add(part.surface_emission, weight);
    if (part.has_surface) {
        surfaces_ += weight;
        normal_.add(part.normal, weight);
        position_.add(part.position, weight);
        if (part.surface_distance < nearest_surface_) {
            nearest_surface_ = part.surface_distance;
            material_ = part.material;
        }
    }
    const double tau = static_cast<double>(part.optical_depth);
    transmittance_ += weight * static_cast<double>(part.transmittance);
    exact_transmittance_ += weight * std::exp(-tau);
    optical_depth_ += weight * tau;
    reservoir_.add(part.reservoir);
    work_.add(part.work);
    exact_rays_ += static_cast<double>(part.exact_rays);
    if (part.collided) {
        collisions_ += weight;
        albedo_.add(part.albedo, weight);
        if (!part.on_surface) {
            in_smoke_ += weight;
            depth_ += weight * static_cast<double>(part.depth);
        }
        nearest_ = std::min(nearest_, part.depth);
        collision_motion_ += weight * glm::dvec2(part.motion);
    } else {
        background_motion_ += weight * glm::dvec2(part.motion);
    }
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
    const auto samples = static_cast<double>(count());
    const double n = std::max(samples, 1.0);
    switch (aov) {
        case Aov::Z:
            values[0] = collisions_ > 0.0 ? nearest_ : background_depth;
            break;
        case Aov::VolumeZ:
            values[0] = in_smoke_ > 0.0 ? static_cast<float>(depth_ / in_smoke_) : background_depth;
            break;
        case Aov::Albedo:
            store(albedo_.mean(samples));
            break;
        case Aov::Motion: {
            const glm::dvec2 motion =
                collisions_ > 0.0 ? collision_motion_ / collisions_ : background_motion_ / n;
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
            store(direct_.mean(samples));
            break;
        case Aov::VolumeIndirect:
            store(indirect_.mean(samples));
            break;
        case Aov::VolumeEmission:
            store(emission_.mean(samples));
            break;
        case Aov::Background:
            store(background_.mean(samples));
            break;
        case Aov::Transmittance:
            store(Spectrum(static_cast<float>(exact_transmittance_ / n)));
            break;
        case Aov::OpticalDepth:
            values[0] = static_cast<float>(optical_depth_ / n);
            break;
        case Aov::Direct:
            store(surface_direct_.mean(samples));
            break;
        case Aov::Indirect:
            store(surface_indirect_.mean(samples));
            break;
        case Aov::Emission:
            store(surface_emission_.mean(samples));
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
            store(reservoir_.mean(samples));
            break;
        case Aov::Cost:
            values[0] = static_cast<float>(exact_rays_ / n);
            break;
        case Aov::Work:
            store(work_.mean(samples));
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
