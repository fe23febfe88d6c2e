#pragma once

#include <string>
#include <vector>

#include "scene/description.h"

namespace mote {

/// Reads and checks a TOML (or, by extension, JSON) scene. `overrides` are "a.b=value" with the
/// value in TOML syntax (a bare word is a string; list entries are addressed by number or name:
/// "volumes.smoke.density_scale=4"). Throws Error(Input) with every problem found, one per line, as
/// `file:line:col: error: ...`; an override's problems name the override instead.
[[nodiscard]] SceneDescription load_scene(const std::string& path,
                                          const std::vector<std::string>& overrides = {});

/// JSON Schema (draft 2020-12) of scene files, generated from the same field list that reads them.
[[nodiscard]] std::string scene_schema_json();

/// The tables of scenes/README.md: every key with type, unit, range and default.
[[nodiscard]] std::string scene_reference_markdown();

}  // namespace mote
