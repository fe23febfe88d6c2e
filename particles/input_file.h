#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace mote {

/// A file read once from front to back through a bounded window, as bytes or as lines.
class InputFile {
  public:
    /// Throws Error(Input) if it is not a readable regular file.
    explicit InputFile(const std::string& path);
    ~InputFile();
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;

    [[nodiscard]] const std::string& path() const { return path_; }
    /// Bytes from the current position to the end.
    [[nodiscard]] uint64_t remaining() const { return size_ - position_; }
    [[nodiscard]] int line_number() const { return line_number_; }

    /// The next `count` bytes (at most `max_take`), valid until the next call. Throws Error(Input)
    /// "truncated" if they are not there.
    const unsigned char* take(size_t count);
    void skip(uint64_t count);

    /// The next line without its end; false at the end of the file. Lines are at most `max_take`.
    bool next_line(std::string_view& line);

    static constexpr size_t max_take = size_t{1} << 20;

  private:
    /// Makes at least `count` bytes available unless the file ends first.
    void fill(size_t count);

    std::string path_;
    int descriptor_ = -1;
    uint64_t size_ = 0;
    uint64_t position_ = 0;
    std::vector<unsigned char> window_;
    size_t begin_ = 0;  ///< of the unread bytes in the window
    size_t end_ = 0;
    int line_number_ = 0;
};

}  // namespace mote
