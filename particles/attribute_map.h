#pragma once

#include <span>
#include <string>
#include <vector>

#include "particles/source.h"

namespace mote {

/// What a column of a particle file means to mote. Density [kg/m^3] becomes mass with the volume
/// of the particle's support ball, where the file has no masses.
enum class ParticleAttribute {
    Position,
    Velocity,
    Radius,
    Mass,
    Density,
    Temperature,
    Color,
    Id,
    Age
};
inline constexpr int attribute_count = 9;

/// mote's name for it, as used in CacheParams::attributes: "position", "velocity", ...
[[nodiscard]] const char* attribute_name(ParticleAttribute attribute);

/// 3 for positions, velocities and colours, 1 for the others.
[[nodiscard]] int attribute_components(ParticleAttribute attribute);

/// One named column of a file: a number, or a vector of numbers.
struct FileField {
    std::string name;
    int components = 1;
};

/// One number of each row: component `field_component` of field `field` is `component` of
/// `attribute`.
struct Binding {
    ParticleAttribute attribute = ParticleAttribute::Position;
    int component = 0;
    size_t field = 0;
    int field_component = 0;
};

/// Finds the wanted attributes among a file's fields: under the names the user gave, else under
/// the usual ones:
///   position     P, pos; x y z; px py pz                  velocity     v, vel; vx vy vz
///   radius       pscale, rad                              mass         m; density (see above)
///   temperature  temp, T                                  color        Cd, colour, rgb; red green
///                                                         blue; r g b
///   id           particle_id, pid                         age
/// A vector may be one field of three numbers or three fields (v.x v.y v.z, v_x .., vx .., v[0] ..,
/// v:0 ..); a user's name may also list three fields ("u,v,w"), or be empty to ignore an attribute.
/// Case matters only for names of one letter. Houdini's "life" is not an age: it is not read.
/// Throws Error(Input) naming file and attribute if positions or a name the user gave are missing.
[[nodiscard]] std::vector<Binding> bind_attributes(const std::string& file,
                                                   std::span<const FileField> fields,
                                                   const CacheParams& params,
                                                   const AttributeMask& mask);

}  // namespace mote
