#include "particles/source_info.h"

#include <algorithm>

#include "particles/cache.h"

namespace mote {

namespace {

double component(Vec3 v, int c)
{
    return double{v[c]};
}
double component(float x, int)
{
    return double{x};
}
double component(int64_t x, int)
{
    return static_cast<double>(x);
}

template <class T>
void add_range(ParticleInfo& info, const char* name, const char* unit, const std::vector<T>& values)
{
    if (values.empty()) return;
    AttributeRange range;
    range.name = name;
    range.unit = unit;
    range.components = std::is_same_v<T, Vec3> ? 3 : 1;
    for (int c = 0; c < range.components; ++c) {
        double lo = component(values[0], c);
        double hi = lo;
        for (const T& value : values) {
            lo = std::min(lo, component(value, c));
            hi = std::max(hi, component(value, c));
        }
        range.lo[c] = lo;
        range.hi[c] = hi;
    }
    info.attributes.push_back(range);
    info.memory_bytes += static_cast<int64_t>(values.size() * sizeof(T));
}

}  // namespace

ParticleInfo describe_particles(const ParticleSet& particles)
{
    ParticleInfo info;
    info.count = static_cast<int64_t>(particles.size());
    for (const Vec3& p : particles.position) info.bounds.extend(p);
    for (const float m : particles.mass) info.total_mass += double{m};
    for (const Vec3& v : particles.velocity) {
        info.largest_speed = std::max(info.largest_speed, glm::length(v));
    }
    add_range(info, "position", "m", particles.position);
    add_range(info, "velocity", "m/s", particles.velocity);
    add_range(info, "radius", "m", particles.radius);
    add_range(info, "mass", "kg", particles.mass);
    add_range(info, "temperature", "K", particles.temperature);
    add_range(info, "color", "", particles.color);
    add_range(info, "id", "", particles.id);
    add_range(info, "age", "s", particles.age);
    return info;
}

ParticleInfo describe_particle_file(const std::string& path, const CacheParams& params, double fps)
{
    return describe_particles(read_particle_file(path, params, fps));
}

ParticleHeader describe_particle_header(const std::string& path, const CacheParams& params)
{
    const PointBuffer buffer = read_points(path, {params, {}, true});
    if (buffer.bindings.empty()) return {};
    std::vector<std::string> names;
    for (const Binding& binding : buffer.bindings) {
        if (binding.component == 0) names.emplace_back(attribute_name(binding.attribute));
    }
    return {names};
}

}  // namespace mote
