#include "scene/problems.h"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"

namespace mote {

void Problems::add(const SourcePosition& where, std::string message)
{
    if (is_full()) {
        ++left_out_;
    } else {
        entries_.push_back({where, std::move(message)});
    }
}

void Problems::throw_if_any() const
{
    if (entries_.empty()) return;
    std::vector<Entry> sorted = entries_;
    std::stable_sort(sorted.begin(), sorted.end(), [](const Entry& a, const Entry& b) {
        return std::tie(a.where.override_index, a.where.line, a.where.column) <
               std::tie(b.where.override_index, b.where.line, b.where.column);
    });
    std::string text;
    for (const Entry& entry : sorted) {
        const SourcePosition& where = entry.where;
        if (!text.empty()) text += '\n';
        if (where.override_index >= 0) {
            const auto index = static_cast<size_t>(where.override_index);
            text += fmt::format("--set {}: error: {}", printable(overrides_[index]), entry.message);
        } else if (where.line > 0) {
            text +=
                fmt::format("{}:{}:{}: error: {}", path_, where.line, where.column, entry.message);
        } else {
            text += fmt::format("{}: error: {}", path_, entry.message);
        }
    }
    if (left_out_ > 0) text += fmt::format("\n{}: {} more errors", path_, left_out_);
    throw Error(ExitCode::Input, text);
}

}  // namespace mote
