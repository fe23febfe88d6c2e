#include "surfaces/gltf/gltf_outline.h"

#include <algorithm>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/text.h"

namespace mote {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

[[noreturn]] void fail(const std::string& path, const std::string& reason)
{
    throw Error(ExitCode::Input, fmt::format("{}: {}", printable(path, 1000), reason));
}

/// tinygltf descends by recursion; nothing that is written deliberately is nested half as deep.
constexpr int max_depth = 64;

/// The events of a JSON text: collects the uris of buffers and images, and "extensionsRequired".
struct Walker : Json::json_sax_t {
    std::string section;  ///< key of the outermost object
    std::string key_at_hand;
    int depth = 0;
    int depth_of_needed = -1;
    bool is_too_deep = false;
    std::vector<std::string> uris, needed;
    std::string version;
    bool has_animations = false;
    size_t error_position = 0;
    bool has_error = false;

    bool open()
    {
        is_too_deep = ++depth > max_depth;
        return !is_too_deep;
    }
    bool close()
    {
        --depth;
        if (depth < depth_of_needed) depth_of_needed = -1;
        return true;
    }
    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool binary(binary_t&) override { return true; }
    bool string(string_t& value) override
    {
        const bool names_files = section == "buffers" || section == "images";
        if (names_files && depth == 3 && key_at_hand == "uri") uris.push_back(value);
        if (section == "asset" && depth == 2 && key_at_hand == "version") version = value;
        if (depth_of_needed >= 0) needed.push_back(value);
        return true;
    }
    bool start_object(std::size_t) override
    {
        has_animations |= section == "animations" && depth == 2;
        return open();
    }
    bool end_object() override { return close(); }
    bool start_array(std::size_t) override
    {
        if (depth == 1 && key_at_hand == "extensionsRequired") depth_of_needed = 2;
        return open();
    }
    bool end_array() override { return close(); }
    bool key(string_t& value) override
    {
        key_at_hand = value;
        if (depth == 1) section = value;
        return true;
    }
    bool parse_error(std::size_t position, const std::string&, const Json::exception&) override
    {
        error_position = position;
        has_error = true;
        return false;
    }
};

uint32_t load_u32(std::string_view bytes, size_t at)
{
    uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

constexpr uint32_t json_chunk = 0x4e4f534a;
constexpr uint32_t binary_chunk = 0x004e4942;

/// The JSON of a GLB; checks header and chunks.
std::string_view json_of_glb(const std::string& path, std::string_view bytes)
{
    if (bytes.size() < 20) fail(path, "truncated: it ends within the GLB header");
    if (load_u32(bytes, 4) != 2) {
        fail(path,
             fmt::format("GLB version {}, mote reads 2; export it again", load_u32(bytes, 4)));
    }
    const size_t length = load_u32(bytes, 8);
    if (length > bytes.size()) {
        fail(path, fmt::format("truncated: {} of {} bytes", bytes.size(), length));
    }
    const size_t json_length = load_u32(bytes, 12);
    if (load_u32(bytes, 16) != json_chunk || json_length > length - std::min<size_t>(length, 20)) {
        fail(path, "damaged: its first chunk is no JSON of the size it claims");
    }
    const size_t next = 20 + json_length;
    if (next < length) {
        const bool has_header = length - next >= 8;
        if (!has_header || load_u32(bytes, next) > length - next - 8 ||
            load_u32(bytes, next + 4) != binary_chunk) {
            fail(path, "damaged: its second chunk is no binary data of the size it claims");
        }
    }
    return bytes.substr(20, json_length);
}

/// Throws if the file that a uri names does not lie in the folder of `path` or below.
void check_uri(const std::string& path, const std::string& uri)
{
    const bool has_scheme = uri.find("://") != std::string::npos;
    const bool has_nul = uri.find('\0') != std::string::npos;
    const fs::path inside = fs::path(uri).lexically_normal();
    const bool leaves = inside.is_absolute() || inside.empty() || *inside.begin() == ".." ||
                        uri.find('\\') != std::string::npos;
    if (has_scheme || has_nul || leaves) {
        fail(path, fmt::format("uri \"{}\" leads out of the file's folder; put the file beside it",
                               printable(uri, 200)));
    }
}

}  // namespace

std::string decode_uri(const std::string& uri)
{
    std::string out;
    for (size_t i = 0; i < uri.size(); ++i) {
        const bool is_code = uri[i] == '%' && i + 2 < uri.size() &&
                             std::isxdigit(static_cast<unsigned char>(uri[i + 1])) != 0 &&
                             std::isxdigit(static_cast<unsigned char>(uri[i + 2])) != 0;
        if (is_code) {
            out.push_back(static_cast<char>(std::stoi(uri.substr(i + 1, 2), nullptr, 16)));
            i += 2;
        } else {
            out.push_back(uri[i]);
        }
    }
    return out;
}

GltfOutline outline_gltf(const std::string& path, std::string_view bytes)
{
    GltfOutline outline;
    outline.is_binary = bytes.substr(0, 4) == "glTF";
    const std::string_view json = outline.is_binary ? json_of_glb(path, bytes) : bytes;
    Walker walker;
    const bool is_whole = Json::sax_parse(json, &walker);
    if (walker.is_too_deep) {
        fail(path, fmt::format("its JSON is nested more than {} deep", max_depth));
    }
    if (!is_whole) {
        const std::string_view before =
            json.substr(0, std::max<size_t>(walker.error_position, 1) - 1);
        const auto line = 1 + std::count(before.begin(), before.end(), '\n');
        const size_t newline = before.rfind('\n');
        const size_t column = before.size() - (newline == std::string_view::npos ? 0 : newline + 1);
        throw Error(ExitCode::Input, fmt::format("{}:{}:{}: not valid JSON; export the file again",
                                                 printable(path, 1000), line, column + 1));
    }
    outline.needed = std::move(walker.needed);
    outline.version = std::move(walker.version);
    outline.has_animations = walker.has_animations;
    const fs::path folder = fs::path(path).parent_path();
    for (const std::string& encoded : walker.uris) {
        if (encoded.starts_with("data:")) continue;
        const std::string uri = decode_uri(encoded);
        check_uri(path, uri);
        const std::string file = (folder / uri).string();
        if (std::find(outline.files.begin(), outline.files.end(), file) != outline.files.end()) {
            continue;
        }
        outline.files.push_back(file);
        std::error_code error;
        const auto size = fs::file_size(file, error);
        if (!error) outline.file_bytes += static_cast<int64_t>(size);
    }
    return outline;
}

}  // namespace mote
