#include "scene/fields.h"

namespace mote {
namespace {

constexpr std::array procedural_names = {"box", "sphere", "puff", "plume"};

}  // namespace

void describe(FieldVisitor& v, ProceduralParams& p)
{
    visit_choice(v,
                 {.key = "type",
                  .doc = "box and sphere have density 1 inside; puff is a soft cloud; plume is "
                         "a rising column of smoke"},
                 p.kind, procedural_names);
    visit(v,
          {.key = "size",
           .doc = "Edges or diameters; one number or one per axis",
           .unit = "m",
           .range = size_range,
           .scalar_ok = true},
          p.size);
    visit(v, {.key = "voxel_size", .doc = "Edge of a voxel", .unit = "m", .range = size_range},
          p.voxel_size);
    visit(v, {.key = "noise", .doc = "Strength of the turbulence", .range = between(0, 1)},
          p.noise);
    visit(v, {.key = "seed", .doc = "Chooses the shape"}, p.seed);
    visit(v,
          {.key = "evolve",
           .doc = "Speed at which the turbulence changes; 0: still",
           .unit = "1/s",
           .range = between(-1e4, 1e4)},
          p.evolve);
}

void describe(FieldVisitor& v, Phase& phase)
{
    visit(v,
          {.key = "g",
           .doc = "Mean cosine: above 0 scatters forwards, 0 evenly, below 0 back",
           .range = between(-0.999, 0.999),
           .also = "anisotropy"},
          phase.g);
    visit(v, {.key = "g_b", .doc = "Mean cosine of a second lobe", .range = between(-0.999, 0.999)},
          phase.g_b);
    visit(v, {.key = "weight_b", .doc = "Share of the second lobe", .range = between(0, 1)},
          phase.weight_b);
}

void describe(FieldVisitor& v, Emission& emission)
{
    visit(v,
          {.key = "scale",
           .doc = "Light per unit of the emission grid; without a file, of density",
           .unit = "1/m",
           .range = between(0, 1e12),
           .also = "emission_scale strength"},
          emission.emission_scale);
    visit(v,
          {.key = "color",
           .doc = "Colour of that light; one number or RGB",
           .range = between(0, 1e6),
           .also = "emission_color",
           .scalar_ok = true},
          emission.emission_color);
    visit(v,
          {.key = "blackbody_scale",
           .doc = "Glow by temperature: radiance of an opaque medium at 1500 K",
           .unit = "W/(m^2 sr)",
           .range = between(0, 1e12),
           .also = "blackbody"},
          emission.blackbody_scale);
    visit(v,
          {.key = "temperature_scale",
           .doc = "Kelvin per unit of the temperature grid",
           .unit = "K",
           .range = between(0, 1e9)},
          emission.temperature_scale);
    visit(v,
          {.key = "temperature_offset",
           .doc = "Added to the temperature",
           .unit = "K",
           .range = between(-1e6, 1e6)},
          emission.temperature_offset);
}

void describe(FieldVisitor& v, VolumeDescription& volume)
{
    visit(v, {.key = "name", .doc = "For messages and overrides"}, volume.name);
    visit_optional_table(v,
                         {.key = "file",
                          .doc = "Density from fog volumes (.vdb), one file or a "
                                 "sequence; text alone is its `path`",
                          .also = "vdb path",
                          .shorthand = "path"},
                         volume.file);
    visit(v,
          {.key = "particles",
           .doc = "Density from the particle system of this name",
           .also = "particle source"},
          volume.particles);
    visit_optional_table(v,
                         {.key = "procedural",
                          .doc = "Density from a formula; text alone is "
                                 "its `type`",
                          .also = "type",
                          .shorthand = "type"},
                         volume.procedural);
    visit(v,
          {.key = "density_scale",
           .doc = "Extinction per unit of density; particles: per kg/m^3",
           .unit = "1/m",
           .range = between(0, 1e20),
           .also = "density sigma_t extinction"},
          volume.density_scale);
    visit(v,
          {.key = "albedo",
           .doc = "Share of the light that is scattered rather than absorbed; one number or RGB",
           .range = between(0, 1),
           .also = "color scattering",
           .scalar_ok = true},
          volume.albedo);
    visit(v, {.key = "use_color", .doc = "Multiply `albedo` by the colours of grid or particles"},
          volume.use_color);
    visit_table(v,
                {.key = "phase",
                 .doc = "Direction of scattering (Henyey-Greenstein); a number "
                        "alone is its `g`",
                 .also = "g anisotropy",
                 .shorthand = "g"},
                volume.phase);
    visit_table(v, {.key = "emission", .doc = "Light given off"}, volume.emission);
    visit(v, {.key = "density_grid", .doc = "Name of the grid in the file"}, volume.density_grid);
    visit(v, {.key = "temperature_grid", .doc = "Read only for blackbody emission"},
          volume.temperature_grid);
    visit(v, {.key = "emission_grid", .doc = "Read only if emission.scale is above 0"},
          volume.emission_grid);
    visit(v, {.key = "color_grid", .doc = "Read only with use_color"}, volume.color_grid);
    visit(v,
          {.key = "velocity_grid",
           .doc = "Read only where motion is asked for; [m/s]; \"\": the file has none, the volume "
                  "is at rest"},
          volume.velocity_grid);
    visit_transform(v, volume.transform);
}

}  // namespace mote
