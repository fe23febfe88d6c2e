#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>

#include "app/options.h"

namespace mote {

/// How progress is shown.
enum class ProgressStyle {
    None,
    Bar,    ///< one line redrawn in place, for terminals
    Lines,  ///< a line every few seconds, for logs
    Json,   ///< one JSON object per line, for farms
};

/// "1:02:03", "2:03" or "4 s"; "?" for a negative (unknown) time [s].
[[nodiscard]] std::string format_duration(double seconds);

/// Progress over the frames of one command, on stderr. Thread-safe where said.
class Progress {
  public:
    /// Where text goes and what time it is [s]; replaced in tests.
    struct Terminal {
        std::function<void(std::string_view)> write;
        std::function<double()> now;
        int columns = 80;
    };

    Progress(ProgressStyle style, int frame_count, Terminal terminal);
    /// Without finish() before, the run counts as stopped.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// A frame starts; `steps` is how often step() will be called in it, as far as known.
    void begin_frame(int frame, int64_t steps);
    /// Part of the frame is done. Any thread, any time; cheap.
    void step();
    /// The frame's file is in place.
    void end_frame(const std::string& file);
    /// A frame needs no work.
    void skip_frame(int frame, const std::string& file);
    /// Last word: all frames are done, or the run was stopped.
    void finish(bool stopped);

    /// Steps that the last finished frame took; 0 before the first.
    [[nodiscard]] int64_t steps_of_last_frame() const { return last_steps_; }

  private:
    void show(const char* event, const std::string& file);
    [[nodiscard]] double fraction() const;
    [[nodiscard]] double eta() const;

    ProgressStyle style_;
    int frame_count_;
    Terminal terminal_;
    double interval_;
    double start_;
    std::mutex mutex_;
    int frame_ = 0;
    int done_ = 0;
    int skipped_ = 0;
    bool finished_ = false;
    int64_t last_steps_ = 0;
    std::atomic<int64_t> steps_{0};
    std::atomic<int64_t> expected_steps_{0};
    std::atomic<double> next_show_;
};

/// A Terminal on stderr with the monotonic clock.
[[nodiscard]] Progress::Terminal stderr_terminal();

/// The style of a command: auto means a bar on a terminal, log lines otherwise, nothing if quiet.
[[nodiscard]] ProgressStyle progress_style(ProgressMode mode, bool quiet);

}  // namespace mote
