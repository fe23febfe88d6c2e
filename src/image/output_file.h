#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

namespace mote {

/// Binary file being written. Writes never fail silently: the first error is kept and finish()
/// throws it, whatever the library in between did with it.
class OutputFile {
  public:
    /// `path` is opened, `shown_path` is the name in messages. Throws Error(Output).
    OutputFile(const std::string& path, std::string shown_path);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    void write(const char* bytes, size_t count);
    void seek(uint64_t position);
    [[nodiscard]] uint64_t position();
    [[nodiscard]] bool failed() const { return error_number_ != 0; }

    /// Closes. Throws Error(Output) with reason and remedy if anything failed since opening.
    void finish();

  private:
    void note_error();

    std::FILE* file_;
    std::string shown_path_;
    int error_number_ = 0;
};

}  // namespace mote
