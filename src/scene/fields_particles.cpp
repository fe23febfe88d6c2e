#include "scene/fields.h"

namespace mote {
namespace {

constexpr std::array emitter_names = {"plume", "burst", "disk", "snow"};
constexpr std::array outside_names = {"hide", "hold", "loop"};
constexpr std::array velocity_unit_names = {"per_second", "per_frame"};
constexpr std::array attribute_names = {"position", "velocity",    "radius", "mass",
                                        "id",       "temperature", "color",  "age"};

}  // namespace

void describe(FieldVisitor& v, SequenceParams& sequence)
{
    visit(v,
          {.key = "path",
           .doc = "File, relative to the scene file; `####`, `%04d` or `$F4` is the frame number",
           .required = true,
           .also = "pattern file"},
          sequence.pattern);
    visit(v,
          {.key = "first",
           .doc = "First frame on disk; with `last` below `first`, the files found in the "
                  "folder from `first` on make the sequence",
           .range = frame_range},
          sequence.first);
    visit(v, {.key = "last", .doc = "Last frame on disk", .range = frame_range}, sequence.last);
    visit(v,
          {.key = "offset",
           .doc = "Frame on disk = frame of the scene + offset",
           .unit = "frames",
           .range = frame_range},
          sequence.offset);
    visit_choice(v,
                 {.key = "outside",
                  .doc = "Before the first and after the last frame: nothing, "
                         "the nearest frame, or start again"},
                 sequence.outside, outside_names);
}

void describe(FieldVisitor& v, ParticlesDescription& particles)
{
    visit(v, {.key = "name", .doc = "What volumes and lights call it", .required = true},
          particles.name);
    visit(v,
          {.key = "voxel_size",
           .doc = "Voxel edge of the grids that the particles are drawn into",
           .unit = "m",
           .range = size_range},
          particles.voxel_size);

    EmitterParams emitter;
    CacheParams cache;
    if (const auto* given = std::get_if<EmitterParams>(&particles.source)) emitter = *given;
    if (const auto* given = std::get_if<CacheParams>(&particles.source)) cache = *given;
    const bool is_cache = std::holds_alternative<CacheParams>(particles.source);

    const bool has_file = v.has({.key = "file", .doc = ""}, is_cache);
    if (has_file) {
        visit_table(v,
                    {.key = "file",
                     .doc = "A cache: .vdb points, .ply, .csv or .npy, one file "
                            "or a sequence; text alone is its `path`",
                     .also = "cache path pattern",
                     .shorthand = "path"},
                    cache.sequence);
    }
    if (v.has({.key = "emitter", .doc = ""}, !is_cache)) {
        visit_choice(v,
                     {.key = "emitter",
                      .doc = "A built-in source: rising smoke, an explosion, "
                             "a swirling disk, falling snow",
                      .also = "type kind"},
                     emitter.kind, emitter_names);
    }
    v.select(has_file ? "file" : "emitter");

    // Shared by both kinds of source.
    float radius = is_cache ? cache.radius : emitter.radius;
    float mass = is_cache ? cache.mass : emitter.mass;
    visit(v,
          {.key = "radius",
           .doc = "Radius over which a particle is spread; caches: where the "
                  "file has none",
           .unit = "m",
           .range = size_range,
           .also = "pscale"},
          radius);
    visit(v,
          {.key = "mass",
           .doc = "Mass of all particles together; caches: where the file has "
                  "none",
           .unit = "kg",
           .range = between(0, 1e12)},
          mass);
    emitter.radius = cache.radius = radius;
    emitter.mass = cache.mass = mass;

    visit(v,
          {.key = "count",
           .doc = "Particles alive in a full frame",
           .range = between(1, 100'000'000),
           .used_by = "emitter"},
          emitter.count);
    visit(v, {.key = "seed", .doc = "Chooses the particles", .used_by = "emitter"}, emitter.seed);
    visit(v,
          {.key = "position",
           .doc = "Centre of the source",
           .unit = "m",
           .range = length_range,
           .used_by = "emitter"},
          emitter.position);
    visit(v,
          {.key = "size",
           .doc = "Radius of the source; snow: half the box's edge",
           .unit = "m",
           .range = Range{0.0, 1e6, true, false},
           .used_by = "emitter"},
          emitter.size);
    visit(v,
          {.key = "speed",
           .doc = "Launch, rise, orbit or fall speed",
           .unit = "m/s",
           .range = between(0, 1e6),
           .used_by = "emitter"},
          emitter.speed);
    visit(v,
          {.key = "lifetime",
           .doc = "From birth to death",
           .unit = "s",
           .range = Range{0.0, 1e6, true, false},
           .used_by = "emitter"},
          emitter.lifetime);
    visit(v,
          {.key = "turbulence",
           .doc = "Speed of the curl noise",
           .unit = "m/s",
           .range = between(0, 1e6),
           .used_by = "emitter"},
          emitter.turbulence);
    visit(v,
          {.key = "turbulence_size",
           .doc = "Size of the largest eddies",
           .unit = "m",
           .range = size_range,
           .used_by = "emitter"},
          emitter.turbulence_size);
    visit(v,
          {.key = "drag",
           .doc = "Decay of the velocity (burst)",
           .unit = "1/s",
           .range = between(0, 1e6),
           .used_by = "emitter"},
          emitter.drag);
    visit(v,
          {.key = "gravity",
           .doc = "Acceleration downwards, along -y",
           .unit = "m/s^2",
           .range = between(-1e6, 1e6),
           .used_by = "emitter"},
          emitter.gravity);
    visit(v,
          {.key = "spread",
           .doc = "Half angle of the launch cone (plume)",
           .unit = "degrees",
           .range = between(0, 80),
           .used_by = "emitter"},
          emitter.spread);
    visit(v,
          {.key = "radius_growth",
           .doc = "Added to the radius while a particle ages",
           .unit = "m/s",
           .range = between(0, 1e6),
           .used_by = "emitter"},
          emitter.radius_growth);
    visit(v,
          {.key = "temperature",
           .doc = "At birth",
           .unit = "K",
           .range = between(0, 1e6),
           .used_by = "emitter"},
          emitter.temperature);
    visit(v,
          {.key = "cooling",
           .doc = "Speed of the exponential approach to 300 K",
           .unit = "1/s",
           .range = between(0, 1e6),
           .used_by = "emitter"},
          emitter.cooling);
    visit(v,
          {.key = "color",
           .doc = "Colour as a share of the albedo; one number or RGB",
           .range = between(0, 1),
           .used_by = "emitter",
           .scalar_ok = true},
          emitter.color);
    visit(v,
          {.key = "start_time",
           .doc = "When emission starts; frame 0 is at 0 s",
           .unit = "s",
           .range = between(-1e6, 1e6),
           .used_by = "emitter"},
          emitter.start_time);

    v.names({.key = "attributes",
             .doc = "mote's name = name in the file, where they differ from "
                    "the usual ones",
             .used_by = "file"},
            cache.attributes, attribute_names);
    visit_choice(
        v, {.key = "velocity_unit", .doc = "Time unit of the file's velocities", .used_by = "file"},
        cache.velocity_unit, velocity_unit_names);
    visit(v,
          {.key = "scale",
           .doc = "Metres per unit of length in the file",
           .unit = "m",
           .range = Range{0.0, 1e6, true, false},
           .used_by = "file"},
          cache.scale);
    visit(v,
          {.key = "radius_scale",
           .doc = "Multiplies the radii of the file",
           .range = Range{0.0, 1e6, true, false},
           .used_by = "file"},
          cache.radius_scale);
    visit(v,
          {.key = "max_particles",
           .doc = "Refuse larger files",
           .range = between(1, 1e10),
           .used_by = "file"},
          cache.max_particles);

    if (!v.assigns()) return;
    if (has_file) {
        particles.source = cache;
    } else {
        particles.source = emitter;
    }
}

}  // namespace mote
