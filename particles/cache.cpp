#include "particles/cache.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/file_name.h"

namespace mote {

PointFormat point_format(const std::string& path)
{
    const std::string ending = lower_extension(path);
    if (ending == ".vdb") return PointFormat::Vdb;
    if (ending == ".ply") return PointFormat::Ply;
    if (ending == ".csv" || ending == ".txt") return PointFormat::Csv;
    if (ending == ".npy") return PointFormat::Npy;
    throw Error(ExitCode::Input,
                fmt::format("{}: unknown kind of particle file; .vdb points, .ply, .csv and .npy "
                            "are read. Houdini writes .vdb points with \"Convert VDB Points\"",
                            path));
}

PointBuffer read_points(const std::string& path, const PointRequest& request)
{
    switch (point_format(path)) {
        case PointFormat::Vdb:
            return read_vdb_points(path, request);
        case PointFormat::Ply:
            return read_ply(path, request);
        case PointFormat::Csv:
            return read_csv(path, request);
        case PointFormat::Npy:
            return read_npy(path, request);
    }
    return {};
}

ParticleSet read_particle_file(const std::string& path, const CacheParams& params, double fps,
                               const AttributeMask& mask)
{
    return finish_points(path, read_points(path, {params, mask}), params, fps);
}

}  // namespace mote
