#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace mote {

/// What is known of a glTF file before a library parses it.
struct GltfOutline {
    bool is_binary = false;           ///< GLB
    std::vector<std::string> files;   ///< that it names, with its folder in front; each once
    std::vector<std::string> needed;  ///< extensions without which it must not be shown
    std::string version;              ///< of the format; empty: it does not say
    bool has_animations = false;
    int64_t file_bytes = 0;  ///< of the files that exist
};

/// A uri's text with %20 and the like replaced.
[[nodiscard]] std::string decode_uri(const std::string& uri);

/// Walks the JSON without building it: syntax, depth of nesting, and that the files it names lie in
/// its folder or below. `path` is the file's, `bytes` its content. Throws Error(Input) naming file
/// and, for JSON, line and column.
[[nodiscard]] GltfOutline outline_gltf(const std::string& path, std::string_view bytes);

/// Whether a file has animations, by its JSON alone. Throws as outline_gltf does.
[[nodiscard]] bool has_gltf_animations(const std::string& path);

}  // namespace mote
