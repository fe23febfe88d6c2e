#include "app/cache_writer.h"

#include "image/atomic_file.h"
#include "particles/rasterize.h"
#include "particles/write_points.h"
#include "volumes/grid_io.h"

namespace mote {

void write_point_file(const std::string& path, const ParticleSet& particles)
{
    write_atomically(
        path, [&](const std::string& temporary_path) { write_points(temporary_path, particles); });
}

void write_grid_file(const std::string& path, const ParticleSet& particles, float voxel_size,
                     const GridChannels& channels)
{
    RasterizeParams params;
    params.voxel_size = voxel_size;
    params.channels = {channels.velocity, channels.temperature, channels.color};
    const ParticleGrids built = rasterize(particles, params);
    openvdb::GridPtrVec grids{built.density};
    if (built.velocity) grids.push_back(built.velocity);
    if (built.temperature) grids.push_back(built.temperature);
    if (built.color) grids.push_back(built.color);
    write_atomically(path,
                     [&](const std::string& temporary_path) { write_vdb(temporary_path, grids); });
}

}  // namespace mote
