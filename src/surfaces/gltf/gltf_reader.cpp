#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "core/error.h"
#include "core/file_name.h"
#include "core/guarded_child.h"
#include "core/memory_cap.h"
#include "core/text.h"
#include "surfaces/gltf/gltf_convert.h"
#include "surfaces/gltf/gltf_outline.h"

namespace mote {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, const std::string& reason)
{
    throw Error(ExitCode::Input, fmt::format("{}: {}", printable(path, 1000), reason));
}

/// A whole file. Throws Error(Input).
std::string read_bytes(const std::string& path)
{
    std::error_code error;
    if (fs::is_directory(path, error)) fail(path, "it is a folder");
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    if (!file) fail(path, std::strerror(errno));
    const auto size = static_cast<int64_t>(file.tellg());
    if (size >= int64_t{1} << 32) fail(path, "larger than 4 GB; split it");
    std::string bytes(static_cast<size_t>(size), '\0');
    file.seekg(0);
    file.read(bytes.data(), size);
    if (!file) fail(path, "cannot be read to its end");
    return bytes;
}

/// Extensions that may be required: those that are shown, and those without which a picture is
/// merely plainer. Lamps and surfaces that ignore light are not among them.
constexpr std::array known_extensions = {
    "KHR_materials_emissive_strength", "KHR_materials_transmission", "KHR_materials_ior",
    "KHR_texture_transform",           "KHR_mesh_quantization",      "KHR_materials_specular",
    "KHR_materials_clearcoat",         "KHR_materials_sheen",        "KHR_materials_volume",
};

void check_version_and_extensions(const std::string& path, const GltfOutline& outline)
{
    for (const std::string& name : outline.needed) {
        const bool is_known = std::find(known_extensions.begin(), known_extensions.end(), name) !=
                              known_extensions.end();
        if (is_known) continue;
        fail(path, fmt::format("it needs the extension {}, which mote does not show; export it "
                               "without",
                               printable(name, 80)));
    }
    if (!outline.version.empty() && !outline.version.starts_with("2.")) {
        fail(path, fmt::format("glTF version {}, mote reads 2; export it again",
                               printable(outline.version, 40)));
    }
}

/// Pictures stay in their files; the scene reads those it shows.
bool is_picture(const std::string& file)
{
    const std::string extension = lower_extension(file);
    return extension != ".bin" && extension != ".glbin";
}

/// tinygltf's view of the disk: the files of the outline and nothing else.
tinygltf::FsCallbacks disk_of(const GltfOutline& outline)
{
    tinygltf::FsCallbacks disk{};
    disk.user_data = const_cast<GltfOutline*>(&outline);
    disk.FileExists = [](const std::string& file, void* user) {
        const auto& files = static_cast<const GltfOutline*>(user)->files;
        std::error_code error;
        return std::find(files.begin(), files.end(), file) != files.end() &&
               fs::is_regular_file(file, error);
    };
    disk.ExpandFilePath = [](const std::string& file, void*) { return file; };
    disk.ReadWholeFile = [](std::vector<unsigned char>* out, std::string* error,
                            const std::string& file, void*) {
        if (is_picture(file)) {
            out->assign(1, 0);
            return true;
        }
        try {
            const std::string bytes = read_bytes(file);
            out->assign(bytes.begin(), bytes.end());
            return true;
        } catch (const Error& e) {
            *error = e.what();
            return false;
        }
    };
    return disk;
}

/// Keeps the file's bytes in place of decoding them.
bool keep_picture(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                  const unsigned char* bytes, int size, void*)
{
    image->image.assign(bytes, bytes + std::max(size, 0));
    return true;
}

tinygltf::Model parse(const std::string& path, const std::string& bytes, const GltfOutline& outline)
{
    tinygltf::TinyGLTF loader;
    loader.SetFsCallbacks(disk_of(outline));
    loader.SetImageLoader(keep_picture, nullptr);
    const std::string folder = fs::path(path).parent_path().string();
    const auto size = static_cast<unsigned>(bytes.size());
    tinygltf::Model model;
    std::string error;
    std::string warning;
    const bool is_read =
        outline.is_binary
            ? loader.LoadBinaryFromMemory(&model, &error, &warning,
                                          reinterpret_cast<const unsigned char*>(bytes.data()),
                                          size, folder)
            : loader.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, folder);
    if (!is_read) {
        fail(path, fmt::format("damaged or incomplete ({}); export it again",
                               printable(error.empty() ? warning : error, 400)));
    }
    return model;
}

/// What reading may use: tinygltf keeps JSON as a tree, about 30 bytes for each of its text.
ChildLimits limits_for(const std::string& bytes, const GltfOutline& outline)
{
    const int64_t json = static_cast<int64_t>(bytes.size());
    ChildLimits limits;
    limits.memory_bytes = 64'000'000 + 40 * json + 4 * outline.file_bytes;
    limits.cpu_seconds = 3 + static_cast<int>((json + outline.file_bytes) / 10'000'000);
    return limits;
}

}  // namespace

std::vector<std::string> gltf_files(const std::string& path)
{
    std::vector<std::string> files{path};
    for (const std::string& file : outline_gltf(path, read_bytes(path)).files) {
        std::error_code error;
        if (fs::is_regular_file(file, error)) files.push_back(file);
    }
    return files;
}

bool has_gltf_animations(const std::string& path)
{
    return outline_gltf(path, read_bytes(path)).has_animations;
}

GltfScene load_gltf(const std::string& path)
{
    const std::string bytes = read_bytes(path);
    const GltfOutline outline = outline_gltf(path, bytes);
    check_version_and_extensions(path, outline);
    const ChildLimits limits = limits_for(bytes, outline);
    run_in_child(path, limits, [&] { (void)parse(path, bytes, outline); });
    tinygltf::Model model;
    {
        const MemoryCap cap(limits.memory_bytes);
        try {
            model = parse(path, bytes, outline);
        } catch (const std::bad_alloc&) {
            throw Error(ExitCode::Memory, fmt::format("{}: not enough memory", printable(path)));
        }
    }
    const GltfSource source{path, model};
    GltfScene scene;
    std::vector<GltfUvChoice> uvs;
    warn_of_left_out(source);
    convert_materials(source, scene, uvs);
    convert_nodes(source, uvs, scene);
    return scene;
}

}  // namespace mote
