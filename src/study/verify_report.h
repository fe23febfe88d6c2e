#pragma once

#include <string>
#include <vector>

#include "study/verify_scene.h"

namespace mote {

/// A result and what is said beside it.
struct VerifyReport {
    const VerifyResult& result;
    std::vector<std::string> notes;  ///< a line each: what was lowered, and why
    PreviewParams view;              ///< of the pictures
    std::string version;             ///< of mote
};

/// The figures as text.
[[nodiscard]] std::string verify_text(const VerifyReport& report);

/// All figures. Those that do not exist (NaN, infinite) are null.
[[nodiscard]] std::string verify_json(const VerifyReport& report);

/// One page with figures, pictures and plots; needs no other file and no network.
[[nodiscard]] std::string verify_html(const VerifyReport& report);

/// Numbers of p-values in 20 bins from 0 to 1, of the tiles of a channel that vary over the runs.
[[nodiscard]] std::vector<int64_t> p_histogram(const ChannelComparison& channel);

/// A tile that stands out.
struct TileFinding {
    std::string channel;
    int column = 0;
    int row = 0;
    double tested = 0.0;     ///< mean over the runs
    double reference = 0.0;  ///< the same
    double t = 0.0;
    double p = 1.0;
};

/// Smallest p of all tiles and channels, how many tests that is among, and how many Holm's
/// procedure rejects at the look's alpha.
struct TileTests {
    int64_t count = 0;
    double smallest_p = 1.0;
    int64_t rejected = 0;
    std::vector<TileFinding> worst;  ///< of least p, least first; at most 3
};
[[nodiscard]] TileTests tile_tests(const Study& study);

}  // namespace mote
