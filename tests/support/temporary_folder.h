#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include <unistd.h>

namespace mote {

[[nodiscard]] inline std::string read_bytes(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

inline void write_bytes(const std::string& path, std::string_view bytes)
{
    std::ofstream(path, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// A fresh folder that is removed with everything in it.
class TemporaryFolder {
  public:
    TemporaryFolder()
    {
        path_ = (std::filesystem::temp_directory_path() / "mote_test_XXXXXX").string();
        if (!::mkdtemp(path_.data())) throw std::filesystem::filesystem_error(path_, {});
    }
    ~TemporaryFolder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] std::string file(const std::string& name) const { return path_ + "/" + name; }
    /// Writes a file of these bytes and returns its path.
    std::string write(const std::string& name, std::string_view bytes) const
    {
        write_bytes(file(name), bytes);
        return file(name);
    }
    /// Names of the entries, in no order.
    [[nodiscard]] std::vector<std::string> entries() const
    {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(path_)) {
            names.push_back(entry.path().filename().string());
        }
        return names;
    }

  private:
    std::string path_;
};

}  // namespace mote
