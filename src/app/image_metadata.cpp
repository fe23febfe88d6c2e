#include "app/image_metadata.h"

#include <cmath>
#include <ctime>
#include <utility>

#include <fmt/format.h>

#include "scene/estimator_text.h"

namespace mote {

namespace {

template <class T>
void set(LayeredImage& image, const std::string& name, T value)
{
    for (Attribute& attribute : image.attributes) {
        if (attribute.name == name) {
            attribute.value = std::move(value);
            return;
        }
    }
    image.attributes.push_back({name, std::move(value)});
}

/// UTC in the form that OpenEXR's capDate has.
std::string date_now()
{
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    char text[32];
    std::strftime(text, sizeof text, "%Y:%m:%d %H:%M:%S", &utc);
    return text;
}

}  // namespace

std::string scene_hash_text(const SceneDescription& scene)
{
    return fmt::format("{:016x}", scene.hash);
}

Attribute::Rational frame_rate(double fps)
{
    // The broadcast rates are written rounded (23.976, 29.97), but mean multiples of 1000/1001.
    for (const unsigned denominator : {1u, 1001u}) {
        const double numerator = std::round(fps * denominator);
        const bool is_multiple = denominator == 1 || std::fmod(numerator, 1000.0) == 0.0;
        if (is_multiple && std::abs(numerator / denominator - fps) < 0.002) {
            return {static_cast<int>(numerator), denominator};
        }
    }
    return {static_cast<int>(std::round(fps * 1000.0)), 1000u};
}

void add_metadata(LayeredImage& image, const SceneDescription& scene, int frame,
                  const std::string& inputs_hash, double render_seconds, bool reproducible)
{
    set(image, "software", std::string("mote " MOTE_VERSION));
    set(image, "mote:version", std::string(MOTE_VERSION));
    set(image, "mote:sceneHash", scene_hash_text(scene));
    if (!inputs_hash.empty()) set(image, "mote:inputsHash", inputs_hash);
    set(image, "mote:scene", scene.name);
    set(image, "mote:frame", frame);
    // Text, because seeds use all 32 bits and OpenEXR's integers are signed.
    set(image, "mote:seed", std::to_string(scene.render.seed));
    set(image, "mote:estimator", estimator_text(scene.render));
    set(image, "mote:spp", scene.render.samples);
    set(image, "mote:bounces", scene.render.path.max_bounces);
    set(image, "framesPerSecond", frame_rate(scene.fps));
    if (reproducible) return;
    set(image, "mote:renderTime", static_cast<float>(render_seconds));
    set(image, "capDate", date_now());
    set(image, "utcOffset", 0.0f);
}

}  // namespace mote
