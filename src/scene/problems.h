#pragma once

#include <string>
#include <vector>

#include "scene/node.h"

namespace mote {

/// Collects everything wrong with a scene, so that one run shows all of it.
class Problems {
  public:
    /// `path` is named in every line; problems of overrides name the override instead.
    Problems(std::string path, const std::vector<std::string>& overrides)
        : path_(std::move(path)), overrides_(overrides)
    {
    }

    void add(const SourcePosition& where, std::string message);

    /// More are counted, not kept: cheap suggestions only while this holds.
    [[nodiscard]] bool is_full() const { return entries_.size() >= max_kept; }

    /// Throws Error(Input) with one line per problem, in file order, if there are any.
    void throw_if_any() const;

  private:
    static constexpr size_t max_kept = 20;
    struct Entry {
        SourcePosition where;
        std::string message;
    };
    std::string path_;
    const std::vector<std::string>& overrides_;
    std::vector<Entry> entries_;
    size_t left_out_ = 0;
};

}  // namespace mote
