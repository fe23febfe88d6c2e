#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "particles/attribute_map.h"
#include "particles/particle_set.h"

namespace mote {

/// How integers of a file become numbers: colours of 8 and 16 bits are display values (sRGB) and
/// are made linear; everything else is taken as it is.
enum class NumberKind { Plain, Color8, Color16 };

/// Particles while a file is read: values as they stand in the file.
struct PointBuffer {
    ParticleSet set;
    std::vector<float> density;     ///< [kg/m^3], or empty
    std::vector<FileField> fields;  ///< of the file, for `mote info`
    std::vector<Binding> bindings;  ///< what was found in which field

    /// Rows [0, count); arrays of attributes without binding stay empty.
    void resize(size_t count);

    void store(const Binding& binding, size_t row, double value, NumberKind kind);
    void store_id(size_t row, int64_t id) { set.id[row] = id; }
};

/// Refuses counts above params.max_particles with Error(Memory), before anything is allocated.
void check_count(const std::string& file, uint64_t count, const CacheParams& params);

/// Turns a filled buffer into world units: scales, default radius and mass, mass from density.
/// Drops particles with non-finite values, radii that are not above 0, negative masses or
/// temperatures, and says how many in the log, once per file.
[[nodiscard]] ParticleSet finish_points(const std::string& file, PointBuffer&& buffer,
                                        const CacheParams& params, double fps);

}  // namespace mote
