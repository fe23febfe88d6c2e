#include "particles/point_buffer.h"

#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "core/error.h"

namespace mote {

namespace {

/// IEC 61966-2-1.
double linear_from_srgb(double c)
{
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

double to_linear(double value, NumberKind kind)
{
    static const auto table = [] {
        std::array<double, 256> linear{};
        for (size_t i = 0; i < linear.size(); ++i) {
            linear[i] = linear_from_srgb(static_cast<double>(i) / 255.0);
        }
        return linear;
    }();
    if (kind == NumberKind::Color8) return table[static_cast<size_t>(value) & 255u];
    if (kind == NumberKind::Color16) return linear_from_srgb(value / 65535.0);
    return value;
}

template <class T>
void compact(std::vector<T>& values, const std::vector<size_t>& kept)
{
    if (values.empty()) return;
    for (size_t i = 0; i < kept.size(); ++i) values[i] = values[kept[i]];
    values.resize(kept.size());
}

bool is_good(float x)
{
    return std::isfinite(x) && x >= 0.0f;
}

bool is_good(const ParticleSet& set, size_t i)
{
    return is_finite(set.position[i]) && is_good(set.radius[i]) && set.radius[i] > 0.0f &&
           is_good(set.mass[i]) && (set.velocity.empty() || is_finite(set.velocity[i])) &&
           (set.temperature.empty() || is_good(set.temperature[i])) &&
           (set.color.empty() || is_finite(set.color[i])) &&
           (set.age.empty() || std::isfinite(set.age[i]));
}

void drop_bad(const std::string& file, ParticleSet& set)
{
    const size_t count = set.size();
    size_t first_bad = 0;
    while (first_bad < count && is_good(set, first_bad)) ++first_bad;
    if (first_bad == count) return;
    std::vector<size_t> kept(first_bad);
    std::iota(kept.begin(), kept.end(), size_t{0});
    for (size_t i = first_bad + 1; i < count; ++i) {
        if (is_good(set, i)) kept.push_back(i);
    }
    compact(set.position, kept);
    compact(set.velocity, kept);
    compact(set.radius, kept);
    compact(set.mass, kept);
    compact(set.temperature, kept);
    compact(set.color, kept);
    compact(set.id, kept);
    compact(set.age, kept);
    spdlog::warn("{}: dropped {} of {} particles with non-finite, negative or zero-radius values",
                 file, count - kept.size(), count);
}

}  // namespace

void PointBuffer::resize(size_t count)
{
    for (const Binding& binding : bindings) {
        switch (binding.attribute) {
            case ParticleAttribute::Position:
                set.position.resize(count);
                break;
            case ParticleAttribute::Velocity:
                set.velocity.resize(count);
                break;
            case ParticleAttribute::Radius:
                set.radius.resize(count);
                break;
            case ParticleAttribute::Mass:
                set.mass.resize(count);
                break;
            case ParticleAttribute::Density:
                density.resize(count);
                break;
            case ParticleAttribute::Temperature:
                set.temperature.resize(count);
                break;
            case ParticleAttribute::Color:
                set.color.resize(count);
                break;
            case ParticleAttribute::Id:
                set.id.resize(count);
                break;
            case ParticleAttribute::Age:
                set.age.resize(count);
                break;
        }
    }
}

void PointBuffer::store(const Binding& binding, size_t row, double value, NumberKind kind)
{
    const auto x = static_cast<float>(value);
    switch (binding.attribute) {
        case ParticleAttribute::Position:
            set.position[row][binding.component] = x;
            break;
        case ParticleAttribute::Velocity:
            set.velocity[row][binding.component] = x;
            break;
        case ParticleAttribute::Radius:
            set.radius[row] = x;
            break;
        case ParticleAttribute::Mass:
            set.mass[row] = x;
            break;
        case ParticleAttribute::Density:
            density[row] = x;
            break;
        case ParticleAttribute::Temperature:
            set.temperature[row] = x;
            break;
        case ParticleAttribute::Color:
            set.color[row][binding.component] = static_cast<float>(to_linear(value, kind));
            break;
        case ParticleAttribute::Id:
            if (std::abs(value) < 0x1p62)
                set.id[row] = static_cast<int64_t>(value);
            else
                set.position[row].x = std::numeric_limits<float>::quiet_NaN();  // to be dropped
            break;
        case ParticleAttribute::Age:
            set.age[row] = x;
            break;
    }
}

void check_count(const std::string& file, uint64_t count, const CacheParams& params)
{
    if (static_cast<double>(count) <= double{params.max_particles}) return;
    throw Error(ExitCode::Memory,
                fmt::format("{}: {} particles, but max_particles is {:.0f}; raise it if the "
                            "machine has the memory (about 60 bytes each)",
                            file, count, params.max_particles));
}

ParticleSet finish_points(const std::string& file, PointBuffer&& buffer, const CacheParams& params,
                          double fps)
{
    ParticleSet set = std::move(buffer.set);
    const size_t count = set.size();
    const float per_second =
        params.velocity_unit == VelocityUnit::PerFrame ? static_cast<float>(fps) : 1.0f;
    for (Vec3& p : set.position) p *= params.scale;
    for (Vec3& v : set.velocity) v *= params.scale * per_second;
    for (float& r : set.radius) r *= params.scale * params.radius_scale;
    if (set.radius.empty()) set.radius.assign(count, params.radius);
    if (set.mass.empty() && !buffer.density.empty()) {
        set.mass.resize(count);
        for (size_t i = 0; i < count; ++i) {
            const float r = set.radius[i];
            set.mass[i] = buffer.density[i] * (4.0f / 3.0f * pi) * r * r * r;
        }
    } else if (set.mass.empty() && count > 0) {
        set.mass.assign(count,
                        static_cast<float>(double{params.mass} / static_cast<double>(count)));
    }
    drop_bad(file, set);
    for (Spectrum& c : set.color) c = glm::clamp(c, 0.0f, 1.0f);
    return set;
}

}  // namespace mote
