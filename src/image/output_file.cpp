#include "image/output_file.h"

#include <cerrno>
#include <utility>

#include "image/atomic_file.h"

namespace mote {
OutputFile::OutputFile(const std::string& path, std::string shown_path)
    : file_(std::fopen(path.c_str(), "wbe")), shown_path_(std::move(shown_path))
{
    if (!file_) throw_output_error(shown_path_, errno);
}

OutputFile::~OutputFile()
{
    if (file_) std::fclose(file_);
}

void OutputFile::note_error()
{
    if (error_number_ == 0) error_number_ = errno != 0 ? errno : EIO;
}

void OutputFile::write(const char* bytes, size_t count)
{
    if (!failed() && std::fwrite(bytes, 1, count, file_) != count) note_error();
}

void OutputFile::seek(uint64_t position)
{
    if (!failed() && fseeko(file_, static_cast<off_t>(position), SEEK_SET) != 0) note_error();
}

uint64_t OutputFile::position()
{
    const off_t position = ftello(file_);
    if (position < 0) note_error();
    return position < 0 ? 0 : static_cast<uint64_t>(position);
}

void OutputFile::finish()
{
    std::FILE* file = std::exchange(file_, nullptr);
    if (std::fclose(file) != 0) note_error();
    if (failed()) throw_output_error(shown_path_, error_number_);
}

}  // namespace mote
