#pragma once

#include <optional>
#include <string>

namespace mote {

/// What to show for frames outside a sequence's range.
enum class OutsideRange { Hide, Hold, Loop };

/// A particle or volume file sequence on disk. `pattern` may hold one frame token in its file
/// name: "####" (as many digits as signs), "%04d" or "%d", "$F4" or "$F". A pattern without a
/// token is one file, shown at every frame.
struct SequenceParams {
    std::string pattern;  ///< path, relative to the scene file
    int first = 0;        ///< lowest frame of the sequence on disk
    int last = -1;        ///< last frame; less than `first`: the files found in the folder
    int offset = 0;       ///< file frame = scene frame + offset
    OutsideRange outside = OutsideRange::Hold;
};

/// First and last file frame of a sequence, both included.
struct FrameRange {
    int first = 0;
    int last = 0;
};

/// Frames that exist: [first, last] as given, or, where `last` is less than `first`, the lowest
/// and highest numbered matching file that is not below `first`. Empty for a pattern without a
/// token. Throws Error(Input) when no file matches.
[[nodiscard]] std::optional<FrameRange> sequence_range(const SequenceParams& sequence,
                                                       const std::string& base_dir);

/// The file shown at a scene frame, with `base_dir` in front of a relative pattern. Empty where
/// the sequence is hidden. Does not look whether the file exists.
[[nodiscard]] std::optional<std::string> sequence_path(const SequenceParams& sequence,
                                                       int scene_frame,
                                                       const std::string& base_dir);

/// sequence_path, checked: throws Error(Input) naming the file if it is missing (a gap in the
/// sequence is an error, never a silently empty frame).
[[nodiscard]] std::optional<std::string> resolve_sequence(const SequenceParams& sequence,
                                                          int scene_frame,
                                                          const std::string& base_dir);

}  // namespace mote
