#include <csignal>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/logging.h"
#include "core/error.h"
#include "core/text.h"

namespace {

using namespace mote;

void print_text(const std::string& text)
{
    std::fputs(text.c_str(), stdout);
}

/// Runs one command; overloads on the options say which.
struct Run {
    void operator()(const PrintText& o) const { print_text(o.text); }
    void operator()(const RenderOptions& o) const { start(o), run_render(o); }
    void operator()(const CheckOptions& o) const { start(o), run_check(o); }
    void operator()(const InfoOptions& o) const { start(o), run_info(o); }
    void operator()(const CacheOptions& o) const { start(o), run_cache(o); }
    void operator()(const SheetOptions& o) const { start(o), run_sheet(o); }
    void operator()(const CompareOptions& o) const { start(o), run_compare(o); }
    void operator()(const BenchOptions& o) const { start(o), run_bench(o); }
    void operator()(const VerifyOptions& o) const { start(o), run_verify(o); }
    void operator()(const SchemaOptions& o) const { run_schema(o); }
    void operator()(const VersionOptions& o) const { run_version(o); }

    template <class Options>
    void start(const Options& options) const
    {
        start_logging(options.log);
    }
};

int fail(ExitCode code, const std::string& message)
{
    report_error(message);
    return static_cast<int>(code);
}

}  // namespace

int main(int argc, char** argv)
{
    // A write over the file size limit is then an error of that write, which keeps old files whole.
    std::signal(SIGXFSZ, SIG_IGN);
    try {
        std::visit(Run{}, parse_command_line(std::vector<std::string>(argv + 1, argv + argc)));
        if (std::fflush(stdout) != 0) return fail(ExitCode::Output, "cannot write to stdout");
        return static_cast<int>(ExitCode::Ok);
    } catch (const Error& error) {
        return fail(error.code(), error.what());
    } catch (const std::bad_alloc&) {
        return fail(ExitCode::Memory,
                    "out of memory, or over --memory-limit; larger voxels, fewer particles or a "
                    "smaller image need less");
    } catch (const std::exception& error) {
        return fail(ExitCode::RenderFailed, "internal failure: " + printable(error.what()));
    } catch (...) {
        return fail(ExitCode::RenderFailed, "internal failure");
    }
}
