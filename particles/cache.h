#pragma once

#include <string>

#include "particles/particle_set.h"
#include "particles/readers.h"
#include "particles/source.h"

namespace mote {

/// Particle file formats, told apart by the file's ending.
enum class PointFormat { Vdb, Ply, Csv, Npy };

/// Throws Error(Input) naming the formats that are read, and the way from those that are not.
[[nodiscard]] PointFormat point_format(const std::string& path);

/// The file as it stands, without conversion to world units.
[[nodiscard]] PointBuffer read_points(const std::string& path, const PointRequest& request);

/// One particle file in world units; see CacheParams for what is assumed where it says nothing.
/// `fps` is used for velocities per frame. Throws Error(Input) or Error(Memory) naming the file.
[[nodiscard]] ParticleSet read_particle_file(const std::string& path, const CacheParams& params,
                                             double fps, const AttributeMask& mask = {});

}  // namespace mote
