#include "scene/scene_io.h"

#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "scene/bind.h"
#include "scene/check.h"
#include "scene/hash_scene.h"
#include "scene/overrides.h"

namespace mote {
namespace {

namespace fs = std::filesystem;

/// The whole file; bounded, so that neither a device nor a huge file eats the memory.
std::string read_text(const std::string& path)
{
    std::error_code error;
    if (fs::is_directory(path, error)) {
        throw Error(ExitCode::Input, fmt::format("{}: is a folder, not a scene file", path));
    }
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        throw Error(ExitCode::Input,
                    fmt::format("{}: cannot read the scene file; does it exist?", path));
    }
    std::string text(max_scene_bytes + 1, '\0');
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<size_t>(file.gcount()));
    if (file.bad()) throw Error(ExitCode::Input, fmt::format("{}: reading failed", path));
    if (text.size() > max_scene_bytes) {
        throw Error(ExitCode::Input, fmt::format("{}: larger than {}, so not a scene file", path,
                                                 format_bytes(double{max_scene_bytes})));
    }
    return text;
}

/// Volumes, particles and images handed over as scenes: their bytes make no helpful syntax error.
void refuse_other_kinds(const std::string& path)
{
    const std::string extension = fs::path(path).extension().string();
    for (const char* other :
         {".vdb", ".ply", ".csv", ".npy", ".exr", ".hdr", ".png", ".jpg", ".jpeg"}) {
        if (extension != other) continue;
        throw Error(ExitCode::Input, fmt::format("{}: not a scene; scenes are .toml or .json files "
                                                 "that name such files, see scenes/README.md",
                                                 path));
    }
}

Node parse_file(const std::string& path, const std::string& text)
{
    const bool is_json = fs::path(path).extension() == ".json";
    return is_json ? parse_json(text) : parse_toml(text);
}

}  // namespace

SceneDescription load_scene(const std::string& path, const std::vector<std::string>& overrides)
{
    refuse_other_kinds(path);
    const std::string text = read_text(path);
    Problems problems(path, overrides);
    Node root;
    try {
        root = parse_file(path, text);
    } catch (const SyntaxError& error) {
        problems.add(error.where, error.message);
        problems.throw_if_any();
    }
    if (root.kind != Node::Kind::Table) {
        problems.add(root.where, fmt::format("a scene is a table, not {}", kind_name(root.kind)));
        problems.throw_if_any();
    }
    for (size_t i = 0; i < overrides.size(); ++i) {
        apply_override(root, overrides[i], static_cast<int>(i), problems);
    }
    SceneDescription scene;
    scene.path = path;
    scene.base_dir = fs::path(path).parent_path().string();
    NodeBinder binder(root, problems);
    describe(binder, scene);
    binder.finish();
    check_scene(scene, root, problems);
    problems.throw_if_any();
    scene.hash = hash_scene(scene);
    return scene;
}

}  // namespace mote
