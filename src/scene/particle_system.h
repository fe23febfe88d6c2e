#pragma once

#include "scene/description.h"

namespace mote {

/// The [[particles]] entry of a name. Throws Error(Input) if there is none.
[[nodiscard]] const ParticlesDescription& find_system(const SceneDescription& description,
                                                      const std::string& name);

/// Throws Error(Input): the source of `system` has no `attribute`, which `user` needs.
[[noreturn]] void missing_attribute(const ParticlesDescription& system, const char* attribute,
                                    const char* user);

}  // namespace mote
