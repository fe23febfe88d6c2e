#include "particles/source.h"

#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "core/error.h"
#include "core/parallel.h"
#include "particles/cache.h"
#include "particles/emitter.h"

namespace mote {

namespace {

/// Frames of an int, with room for offsets of callers.
int whole_frame(double frame)
{
    if (!(std::abs(frame) < 1e9)) {
        throw Error(ExitCode::Input, fmt::format("frame {} is out of range", frame));
    }
    return static_cast<int>(std::floor(frame));
}

/// Seconds past the cache's file at a fractional frame. 0 where the file is held or still: moving
/// on would only jump back at the next whole frame.
double seconds_past_file(const CacheParams& cache, double frame, double fps,
                         const std::string& base_dir)
{
    const int whole = whole_frame(frame);
    const double fraction = frame - whole;
    if (fraction == 0.0) return 0.0;
    const bool is_moving = sequence_path(cache.sequence, whole, base_dir) !=
                           sequence_path(cache.sequence, whole + 1, base_dir);
    return is_moving ? fraction / fps : 0.0;
}

void advance(ParticleSet& set, double seconds)
{
    const auto dt = static_cast<float>(seconds);
    parallel_for(set.velocity.size(), 65536, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) set.position[i] += dt * set.velocity[i];
    });
    for (float& age : set.age) age += dt;
}

ParticleSet cache_at(const CacheParams& cache, double frame, double fps,
                     const std::string& base_dir, const AttributeMask& mask)
{
    const auto path = resolve_sequence(cache.sequence, whole_frame(frame), base_dir);
    if (!path) return {};
    const double seconds = seconds_past_file(cache, frame, fps, base_dir);
    AttributeMask needed = mask;
    needed.velocity = mask.velocity || seconds > 0.0;
    ParticleSet set = read_particle_file(*path, cache, fps, needed);
    if (seconds > 0.0) advance(set, seconds);
    if (!mask.velocity) set.velocity.clear();
    return set;
}

/// FNV-1a, finished so that all bits depend on all bytes.
uint64_t hash_text(const std::string& text)
{
    uint64_t hash = 0xcbf29ce484222325u;
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    hash ^= hash >> 32u;
    return hash * 0xd6e8feb86659fd93u;
}

std::string text(Vec3 v)
{
    return fmt::format("{} {} {}", v.x, v.y, v.z);
}

/// Floats are written so that reading them back gives the same bits: equal text, equal values.
std::string version_text(const EmitterParams& p, double frame, double fps, const std::string&)
{
    double time = frame / fps;
    const double since_start = time - double{p.start_time};
    const bool is_over = p.kind == EmitterKind::Burst && since_start >= double{p.lifetime};
    if (since_start < 0.0 || is_over) time = -1e30;  // empty, whenever that is
    return fmt::format("emitter {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {}",
                       static_cast<int>(p.kind), p.count, p.seed, text(p.position), p.size, p.speed,
                       p.lifetime, p.turbulence, p.turbulence_size, p.drag, p.gravity, p.spread,
                       p.radius, p.radius_growth, p.mass, p.temperature, p.cooling, text(p.color),
                       p.start_time, time);
}

std::string version_text(const CacheParams& p, double frame, double fps,
                         const std::string& base_dir)
{
    const auto path = resolve_sequence(p.sequence, whole_frame(frame), base_dir);
    if (!path) return "hidden";
    std::error_code error;
    const auto size = std::filesystem::file_size(*path, error);
    const auto time = std::filesystem::last_write_time(*path, error).time_since_epoch().count();
    std::string version =
        fmt::format("cache {} {} {} {} {} {} {} {} {} {} {}", *path, size, time,
                    static_cast<int>(p.velocity_unit), fps, p.scale, p.radius, p.radius_scale,
                    p.mass, p.max_particles, seconds_past_file(p, frame, fps, base_dir));
    for (const auto& [key, name] : p.attributes) version += fmt::format("\n{}={}", key, name);
    return version;
}

void check_rate(double fps)
{
    if (fps > 0.0 && std::isfinite(fps)) return;
    throw Error(ExitCode::Input, fmt::format("fps must be above 0, not {}", fps));
}

}  // namespace

ParticleSet particles_at(const SourceParams& source, double frame, double fps,
                         const std::string& base_dir, const AttributeMask& mask)
{
    check_rate(fps);
    if (const auto* emitter = std::get_if<EmitterParams>(&source)) {
        return emit_particles(*emitter, frame / fps, mask);
    }
    return cache_at(std::get<CacheParams>(source), frame, fps, base_dir, mask);
}

uint64_t source_version(const SourceParams& source, double frame, double fps,
                        const std::string& base_dir)
{
    check_rate(fps);
    return std::visit(
        [&](const auto& params) { return hash_text(version_text(params, frame, fps, base_dir)); },
        source);
}

}  // namespace mote
