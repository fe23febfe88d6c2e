#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "core/error.h"
#include "scene/scene_io.h"

namespace mote::test {

/// A file that lives as long as this object, in a folder of its own.
class TemporaryFile {
  public:
    TemporaryFile(const std::string& name, const std::string& content)
    {
        static int counter = 0;
        folder_ = std::filesystem::temp_directory_path() /
                  ("mote_test_" + std::to_string(getpid()) + "_" + std::to_string(counter++));
        std::filesystem::create_directories(folder_);
        path_ = (folder_ / name).string();
        std::ofstream(path_, std::ios::binary) << content;
    }
    ~TemporaryFile() { std::filesystem::remove_all(folder_); }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    [[nodiscard]] const std::string& path() const { return path_; }

  private:
    std::filesystem::path folder_;
    std::string path_;
};

/// The scene of a TOML text.
inline SceneDescription load_text(const std::string& toml,
                                  const std::vector<std::string>& overrides = {})
{
    const TemporaryFile file("scene.toml", toml);
    return load_scene(file.path(), overrides);
}

/// What load_scene says about a wrong scene, with the folder left out: "scene.toml:3:1: error:
/// ...".
inline std::string problems_of(const std::string& text,
                               const std::vector<std::string>& overrides = {},
                               const std::string& name = "scene.toml")
{
    const TemporaryFile file(name, text);
    try {
        (void)load_scene(file.path(), overrides);
    } catch (const Error& error) {
        std::string message = error.what();
        const std::string folder = std::filesystem::path(file.path()).parent_path().string() + "/";
        for (size_t at; (at = message.find(folder)) != std::string::npos;) {
            message.erase(at, folder.size());
        }
        return error.code() == ExitCode::Input ? message : "wrong exit code: " + message;
    }
    return "no error";
}

}  // namespace mote::test
