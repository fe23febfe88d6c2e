#include "app/logging.h"

#include <cstdio>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include <unistd.h>

#include <fmt/format.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/spdlog.h>

#include "app/json_text.h"
#include "core/error.h"
#include "core/text.h"

namespace mote {

namespace {

bool json_lines = false;

/// Starts a line of its own even where a progress bar is being drawn.
std::string line(const std::string& text)
{
    static const bool terminal = isatty(STDERR_FILENO) != 0;
    return (terminal ? "\r\x1b[K" : "") + text + "\n";
}

void print(const std::string& text)
{
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

class StderrSink : public spdlog::sinks::base_sink<std::mutex> {
  protected:
    void sink_it_(const spdlog::details::log_msg& message) override
    {
        const std::string text(message.payload.data(), message.payload.size());
        if (json_lines) {
            const auto level = spdlog::level::to_string_view(message.level);
            print(fmt::format("{{\"event\":\"log\",\"level\":\"{}\",\"message\":{}}}\n",
                              std::string(level.data(), level.size()), json_quote(text)));
            return;
        }
        const bool is_warning = message.level >= spdlog::level::warn;
        print(line(std::string("mote: ") + (is_warning ? "warning: " : "") + text));
    }
    void flush_() override {}
};

spdlog::level::level_enum level_of(int verbosity)
{
    if (verbosity <= 0) return spdlog::level::warn;
    return verbosity == 1 ? spdlog::level::info : spdlog::level::debug;
}

}  // namespace

void start_logging(const LogOptions& options)
{
    json_lines = options.json;
    auto console = std::make_shared<StderrSink>();
    console->set_level(options.quiet ? spdlog::level::err : level_of(options.verbosity));
    std::vector<spdlog::sink_ptr> sinks{console};
    if (!options.file.empty()) {
        try {
            auto file = std::make_shared<spdlog::sinks::basic_file_sink_mt>(options.file);
            file->set_pattern("%Y-%m-%dT%H:%M:%S.%e%z [%l] %v");
            file->set_level(options.verbosity > 1 ? spdlog::level::debug : spdlog::level::info);
            sinks.push_back(std::move(file));
        } catch (const spdlog::spdlog_ex& e) {
            throw Error(ExitCode::Output, fmt::format("{}: cannot open the log file: {}",
                                                      options.file, printable(e.what())));
        }
    }
    auto logger = std::make_shared<spdlog::logger>("mote", sinks.begin(), sinks.end());
    logger->set_level(spdlog::level::debug);
    logger->flush_on(spdlog::level::info);
    spdlog::set_default_logger(std::move(logger));
}

void report_error(const std::string& message)
{
    // The log file gets it too, stderr exactly once and in full.
    for (const auto& sink : spdlog::default_logger()->sinks()) {
        if (dynamic_cast<spdlog::sinks::basic_file_sink_mt*>(sink.get()) == nullptr) continue;
        sink->log(spdlog::details::log_msg("mote", spdlog::level::err, message));
        sink->flush();
    }
    print(json_lines ? fmt::format("{{\"event\":\"error\",\"message\":{}}}\n", json_quote(message))
                     : line("mote: " + message));
}

}  // namespace mote
