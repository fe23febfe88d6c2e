#include "app/text_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "image/atomic_file.h"
#include "image/output_file.h"

namespace mote {

std::string read_text_file(const std::string& path)
{
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(file), {}};
    if (!file.good() && !file.eof()) {
        const int reason = errno;
        throw Error(ExitCode::Input, fmt::format("{}: cannot read it ({})", printable(path, 1000),
                                                 std::strerror(reason)));
    }
    return text;
}

void write_text_file(const std::string& path, const std::string& text)
{
    write_atomically(path, [&](const std::string& temporary_path) {
        OutputFile file(temporary_path, path);
        file.write(text.data(), text.size());
        file.finish();
    });
}

}  // namespace mote
