#pragma once

#include <string>

#include "scene/node.h"
#include "scene/problems.h"

namespace mote {

/// Writes "a.b=value" into the tree; `index` is the override's number in messages. Path parts are
/// keys, list entries their number (from 0) or `name`. Missing tables are made, so that their keys
/// are checked like those of the file. Problems are collected.
void apply_override(Node& root, const std::string& text, int index, Problems& problems);

}  // namespace mote
