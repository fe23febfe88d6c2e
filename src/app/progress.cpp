#include "app/progress.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include <sys/ioctl.h>
#include <unistd.h>

#include <fmt/format.h>

#include "app/json_text.h"

namespace mote {

namespace {

/// Seconds between two displays.
double interval_of(ProgressStyle style)
{
    switch (style) {
        case ProgressStyle::Bar:
            return 0.2;
        case ProgressStyle::Json:
            return 1.0;
        case ProgressStyle::Lines:
        case ProgressStyle::None:
            break;
    }
    return 5.0;
}

std::string bar_line(double fraction, const std::string& text, int columns)
{
    const int width = std::clamp(columns - static_cast<int>(text.size()) - 4, 0, 40);
    const auto filled = static_cast<size_t>(fraction * width);
    std::string bar(filled, '=');
    bar.resize(static_cast<size_t>(width), ' ');
    const std::string line = width > 0 ? fmt::format("[{}] {}", bar, text) : text;
    // A line as long as the terminal is wide would wrap and then not be redrawn in place.
    const auto length = static_cast<size_t>(std::max(columns - 1, 1));
    return fmt::format("\r{}\x1b[K", line.substr(0, length));
}

}  // namespace

std::string format_duration(double seconds)
{
    if (!(seconds >= 0.0) || seconds > 1e9) return "?";
    const int64_t s = std::llround(seconds);
    if (s >= 3600) return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
    if (s >= 60) return fmt::format("{}:{:02}", s / 60, s % 60);
    return fmt::format("{} s", s);
}

Progress::Progress(ProgressStyle style, int frame_count, Terminal terminal)
    : style_(style),
      frame_count_(frame_count),
      terminal_(std::move(terminal)),
      interval_(interval_of(style)),
      start_(terminal_.now()),
      next_show_(start_ + interval_)
{
}

Progress::~Progress()
{
    if (!finished_) finish(true);
}

double Progress::fraction() const
{
    if (frame_count_ <= 0) return 1.0;
    const auto expected = static_cast<double>(std::max<int64_t>(expected_steps_, 1));
    // Never quite 1 before the file is in place, however wrong the expected number of steps was.
    const double part = std::min(static_cast<double>(steps_) / expected, 0.99);
    return (done_ + skipped_ + part) / frame_count_;
}

double Progress::eta() const
{
    const double rendered = fraction() * frame_count_ - skipped_;
    const double left = frame_count_ - skipped_ - rendered;
    if (left <= 0.0) return 0.0;
    if (rendered <= 0.0) return -1.0;
    return (terminal_.now() - start_) / rendered * left;
}

void Progress::begin_frame(int frame, int64_t steps)
{
    const std::lock_guard lock(mutex_);
    frame_ = frame;
    steps_ = 0;
    expected_steps_ = steps;
    if (style_ == ProgressStyle::Json) show("begin", "");
}

void Progress::step()
{
    ++steps_;
    if (style_ == ProgressStyle::None || terminal_.now() < next_show_) return;
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (lock.owns_lock() && terminal_.now() >= next_show_) show("progress", "");
}

void Progress::end_frame(const std::string& file)
{
    const std::lock_guard lock(mutex_);
    last_steps_ = steps_;
    steps_ = 0;
    ++done_;
    if (style_ == ProgressStyle::Lines && terminal_.now() < next_show_ &&
        done_ + skipped_ < frame_count_) {
        return;
    }
    show("frame", file);
}

void Progress::skip_frame(int frame, const std::string& file)
{
    const std::lock_guard lock(mutex_);
    frame_ = frame;
    steps_ = 0;
    ++skipped_;
    if (style_ == ProgressStyle::Json) show("skip", file);
}

void Progress::finish(bool stopped)
{
    const std::lock_guard lock(mutex_);
    finished_ = true;
    if (style_ == ProgressStyle::Json) {
        show(stopped ? "stopped" : "done", "");
        return;
    }
    if (style_ == ProgressStyle::None) return;
    if (style_ == ProgressStyle::Bar) terminal_.write("\r\x1b[K");
    terminal_.write(fmt::format("{} of {} frames done{} in {}{}\n", done_, frame_count_,
                                skipped_ > 0 ? fmt::format(", {} already there", skipped_) : "",
                                format_duration(terminal_.now() - start_),
                                stopped ? ", stopped" : ""));
}

void Progress::show(const char* event, const std::string& file)
{
    if (style_ == ProgressStyle::None) return;
    next_show_ = terminal_.now() + interval_;
    const bool frame_is_done = !file.empty();
    const int number = done_ + skipped_ + (frame_is_done ? 0 : 1);
    if (style_ == ProgressStyle::Json) {
        const double seconds = eta();
        terminal_.write(fmt::format(
            "{{\"event\":\"{}\",\"frame\":{},\"done\":{},\"frames\":{},\"fraction\":{:.4f},"
            "\"elapsed_s\":{:.2f},\"eta_s\":{}{}}}\n",
            event, frame_, done_ + skipped_, frame_count_, fraction(), terminal_.now() - start_,
            seconds < 0.0 ? "null" : fmt::format("{:.2f}", seconds),
            file.empty() ? "" : fmt::format(",\"file\":{}", json_quote(file))));
        return;
    }
    const std::string text = fmt::format("frame {} ({}/{}) {:3.0f}%  {} left", frame_, number,
                                         frame_count_, 100.0 * fraction(), format_duration(eta()));
    terminal_.write(style_ == ProgressStyle::Bar ? bar_line(fraction(), text, terminal_.columns)
                                                 : "mote: " + text + "\n");
}

Progress::Terminal stderr_terminal()
{
    Progress::Terminal terminal;
    terminal.write = [](std::string_view text) {
        // One write per line, so that lines of several processes do not mix.
        std::fwrite(text.data(), 1, text.size(), stderr);
        std::fflush(stderr);
    };
    terminal.now = [] {
        const auto t = std::chrono::steady_clock::now().time_since_epoch();
        return std::chrono::duration<double>(t).count();
    };
    winsize size{};
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) {
        terminal.columns = size.ws_col;
    }
    return terminal;
}

ProgressStyle progress_style(ProgressMode mode, bool quiet)
{
    if (mode == ProgressMode::Json) return ProgressStyle::Json;
    if (mode == ProgressMode::None || quiet) return ProgressStyle::None;
    return isatty(STDERR_FILENO) != 0 ? ProgressStyle::Bar : ProgressStyle::Lines;
}

}  // namespace mote
