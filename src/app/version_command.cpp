#include <OpenEXR/OpenEXRConfig.h>
#include <fmt/format.h>
#include <openvdb/version.h>
#include <spdlog/version.h>
#include <tbb/version.h>

#include "app/commands.h"
#include "volumes/walk_isa.h"

namespace mote {

void run_version(const VersionOptions&)
{
    fmt::print("mote {}\n", MOTE_VERSION);
    fmt::print("built     {} {}, {}, -march={}\n",
#ifdef __clang__
               "clang", __clang_version__,
#else
               "gcc", __VERSION__,
#endif
               MOTE_BUILD_TYPE, MOTE_ARCH);
    fmt::print("ray walk  {} (--isa)\n", name_of(walk_isa()));
    fmt::print("libraries OpenVDB {}, OpenEXR {}, oneTBB {}, fmt {}.{}.{}, spdlog {}.{}.{}\n",
               OPENVDB_LIBRARY_VERSION_STRING, OPENEXR_VERSION_STRING, TBB_VERSION_STRING,
               FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100, SPDLOG_VER_MAJOR,
               SPDLOG_VER_MINOR, SPDLOG_VER_PATCH);
}

}  // namespace mote
