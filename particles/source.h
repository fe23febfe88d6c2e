#pragma once

#include <map>
#include <string>
#include <variant>

#include "particles/particle_set.h"
#include "particles/sequence.h"

namespace mote {

/// Built-in emitters. All are functions of time alone: any frame is computed directly and is
/// bit-identical whichever frames were computed before.
enum class EmitterKind { Plume, Burst, Disk, Snow };

/// A procedural particle source. Lengths are in metres, times in seconds, angles in degrees.
struct EmitterParams {
    EmitterKind kind = EmitterKind::Plume;
    int64_t count = 100'000;       ///< particles alive in a full frame, [1, 10^8]
    uint32_t seed = 1;             ///< which particles; same seed, same cloud
    Vec3 position{0.0f};           ///< centre of the source [m]
    float size = 0.25f;            ///< radius of the source [m] (snow: half the box's edge)
    float speed = 1.0f;            ///< typical launch, rise, orbit or fall speed [m/s]
    float lifetime = 4.0f;         ///< seconds from birth to death
    float turbulence = 0.5f;       ///< curl-noise speed [m/s]
    float turbulence_size = 0.5f;  ///< size of the largest curl-noise eddies [m]
    float drag = 1.0f;             ///< velocity decay [1/s] (burst); plume: what limits sinking
    float gravity = 0.0f;          ///< downward acceleration [m/s^2], along -y
    float spread = 15.0f;          ///< half angle at which a plume widens [degrees], [0, 80]
    float radius = 0.03f;          ///< kernel support radius of a particle [m]
    float radius_growth = 0.0f;    ///< added to the radius per second of age [m/s]
    float mass = 1.0f;             ///< total mass of the particles alive in a full frame [kg]
    float temperature = 300.0f;    ///< at birth [K]
    float cooling = 0.0f;          ///< exponential approach to 300 K [1/s]
    Spectrum color{1.0f};          ///< albedo colour, [0,1]
    float start_time = 0.0f;       ///< seconds at which emission starts
};

/// Time unit of a cache's velocity attribute.
enum class VelocityUnit { PerSecond, PerFrame };

/// A particle cache: .vdb points, .ply (ascii or binary, both endians), .csv or .npy.
struct CacheParams {
    SequenceParams sequence;
    /// mote's attribute name -> name in the file, e.g. {"radius", "pscale"}. Unlisted attributes
    /// are looked for under their usual names.
    std::map<std::string, std::string> attributes;
    VelocityUnit velocity_unit = VelocityUnit::PerSecond;
    float scale = 1.0f;          ///< metres per file unit of length
    float radius = 0.03f;        ///< support radius [m] where the file has none
    float radius_scale = 1.0f;   ///< multiplies the file's radius
    float mass = 1.0f;           ///< total mass [kg] where the file has no masses
    float max_particles = 2e8f;  ///< refuse larger files
};

using SourceParams = std::variant<EmitterParams, CacheParams>;

/// Which optional attributes a caller needs; a source may skip the others.
struct AttributeMask {
    bool velocity = true;
    bool temperature = true;
    bool color = true;
    bool id = true;
    bool age = true;
};

/// Particles at a (possibly fractional) scene frame; emitters take frame / fps as their time [s].
/// `base_dir` resolves relative paths. Caches take the nearest whole frame at or below, advanced
/// by velocity for the fraction unless the next frame shows the same file. Particles with
/// non-finite values, radii that are not above 0 or negative masses are dropped, with a count in
/// the log.
/// Throws Error(Input) naming the file and the remedy.
[[nodiscard]] ParticleSet particles_at(const SourceParams& source, double frame, double fps,
                                       const std::string& base_dir, const AttributeMask& mask = {});

/// Changes exactly when particles_at could return something else: the key under which rasterised
/// grids may be kept (emitter parameters and time, or file path, size and modification time).
[[nodiscard]] uint64_t source_version(const SourceParams& source, double frame, double fps,
                                      const std::string& base_dir);

}  // namespace mote
