#include "app/frame_files.h"

#include <cerrno>
#include <filesystem>
#include <set>
#include <variant>

#include <fcntl.h>
#include <unistd.h>

#include <fmt/format.h>

#include "app/output_pattern.h"
#include "core/error.h"
#include "core/text.h"
#include "image/atomic_file.h"
#include "image/exr.h"

namespace mote {

namespace {

namespace fs = std::filesystem;

void require_extension(const std::string& pattern, const std::string& extension)
{
    if (fs::path(pattern).extension() == extension) return;
    throw Error(ExitCode::Usage,
                fmt::format("file pattern \"{}\" must end in {}", printable(pattern), extension));
}

fs::path folder_of(const std::string& path)
{
    const fs::path folder = fs::path(path).parent_path();
    return folder.empty() ? fs::path(".") : folder;
}

/// A text attribute; "" if there is none.
std::string text_of(const LayeredImage& header, const std::string& name)
{
    const Attribute* attribute = header.find_attribute(name);
    const auto* text = attribute ? std::get_if<std::string>(&attribute->value) : nullptr;
    return text ? *text : "";
}

}  // namespace

std::vector<FrameFiles> frame_files(const std::vector<int>& frames,
                                    const std::string& image_pattern,
                                    const std::string& preview_pattern)
{
    require_extension(image_pattern, ".exr");
    const auto images = expand_pattern(image_pattern, frames, "output");
    std::vector<std::string> previews(images.size());
    if (!preview_pattern.empty()) {
        require_extension(preview_pattern, ".png");
        previews = expand_pattern(preview_pattern, frames, "preview");
    }
    std::vector<FrameFiles> files;
    files.reserve(frames.size());
    for (size_t i = 0; i < frames.size(); ++i) {
        files.push_back({frames[i], images[i], previews[i]});
    }
    return files;
}

ExistingImage check_existing(const std::string& path, ExistingMode mode,
                             const ExpectedImage& expected)
{
    std::error_code error;
    if (!fs::exists(path, error)) return {false, "new"};
    if (mode == ExistingMode::Overwrite) return {false, "overwrite"};
    if (mode == ExistingMode::Verify) {
        // The header first: it is cheap, and most files that differ differ there.
        LayeredImage header;
        try {
            header = read_exr_header(path);
        } catch (const Error&) {
            return {false, "damaged"};
        }
        if (header.width != expected.width || header.height != expected.height) {
            return {false, "other size"};
        }
        if (text_of(header, "mote:sceneHash") != expected.scene_hash) return {false, "other scene"};
        if (text_of(header, "mote:inputsHash") != expected.inputs_hash) {
            return {false, "input files changed"};
        }
    }
    if (!is_complete_exr(path)) return {false, "damaged"};
    return {true, mode == ExistingMode::Verify ? "complete, same scene and inputs" : "complete"};
}

void require_writable_folder(const std::string& path)
{
    const fs::path folder = folder_of(path);
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw_output_error(path, error.value());
    const int file = open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600);
    if (file >= 0) {
        close(file);
    } else if (errno != EOPNOTSUPP && errno != EISDIR && errno != EINVAL) {
        // Those three mean that the file system knows no unnamed files: the first write decides.
        throw_output_error(path, errno);
    }
}

void remove_own_temporaries(const std::vector<FrameFiles>& files)
{
    std::set<fs::path> folders;
    for (const FrameFiles& f : files) {
        folders.insert(folder_of(f.image));
        if (!f.preview.empty()) folders.insert(folder_of(f.preview));
    }
    const std::string mark = fmt::format(".{}.tmp.", getpid());
    std::error_code error;
    for (const fs::path& folder : folders) {
        for (fs::directory_iterator it(folder, error), end; !error && it != end;
             it.increment(error)) {
            const std::string name = it->path().filename().string();
            std::error_code ignored;
            if (name[0] == '.' && name.find(mark) != std::string::npos) {
                fs::remove(it->path(), ignored);
            }
        }
    }
}

}  // namespace mote
