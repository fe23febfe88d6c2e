#pragma once

#include <string>

#include "core/error.h"
#include "scene/scene_io.h"
#include "support/temporary_folder.h"

namespace mote::test {

/// The scene of a TOML text.
inline SceneDescription load_text(const std::string& toml,
                                  const std::vector<std::string>& overrides = {})
{
    const TemporaryFolder folder;
    return load_scene(folder.write("scene.toml", toml), overrides);
}

/// What load_scene says about a wrong scene, with the folder left out: "scene.toml:3:1: error:
/// ...".
inline std::string problems_of(const std::string& text,
                               const std::vector<std::string>& overrides = {},
                               const std::string& name = "scene.toml")
{
    const TemporaryFolder folder;
    try {
        (void)load_scene(folder.write(name, text), overrides);
    } catch (const Error& error) {
        std::string message = error.what();
        const std::string prefix = folder.path() + "/";
        for (size_t at; (at = message.find(prefix)) != std::string::npos;) {
            message.erase(at, prefix.size());
        }
        return error.code() == ExitCode::Input ? message : "wrong exit code: " + message;
    }
    return "no error";
}

}  // namespace mote::test
