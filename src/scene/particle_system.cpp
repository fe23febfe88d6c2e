#include "scene/particle_system.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"

namespace mote {

const ParticlesDescription& find_system(const SceneDescription& description,
                                        const std::string& name)
{
    for (const ParticlesDescription& system : description.particles) {
        if (system.name == name) return system;
    }
    throw Error(ExitCode::Input,
                fmt::format("no [[particles]] entry is named \"{}\"", printable(name)));
}

void missing_attribute(const ParticlesDescription& system, const char* attribute, const char* user)
{
    throw Error(ExitCode::Input,
                fmt::format("particles \"{}\": the source has no {}, which {} needs; name the "
                            "file's attribute under \"attributes\" or do without",
                            system.name, attribute, user));
}

}  // namespace mote
