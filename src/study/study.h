#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "image/layers.h"
#include "runs/pixel_stats.h"
#include "study/look.h"

namespace mote {

/// An independent run of an estimator: its image, a function of the seed alone.
using RunSource = std::function<LayeredImage(uint32_t seed)>;

/// How long to go on, and how to look.
struct StudyParams {
    Question question;
    int tile_size = 8;     ///< [px]
    int first_look = 32;   ///< runs before the first verdict
    int most_runs = 4096;  ///< of each estimator
    double seconds = 0.0;  ///< by the clock; 0: no limit. No new round is begun after it
    uint32_t seed = 1;     ///< of the first run; the reference's are far from it
    int kept_runs = 8;     ///< images of the tested estimator kept for figures of single runs
};

/// Two sets of runs, what they showed and when.
struct Study {
    TileStats tested{8}, reference{8};
    TileStats tested_pixels{1}, reference_pixels{1};  ///< tiles of one pixel, of R, G and B alone
    PixelStats reference_mean;                        ///< the same for figures of single runs
    std::vector<Buffer2D<Spectrum>> kept;             ///< the last runs of the tested estimator
    std::vector<Look> looks;
    double seconds = 0.0;

    [[nodiscard]] const Look& last() const { return looks.back(); }
    [[nodiscard]] Verdict verdict() const { return last().verdict; }
};

/// Seeds of the reference's runs begin here, those of short runs before a study at short_run_seed.
inline constexpr uint32_t reference_seed = 0x50000000u;
inline constexpr uint32_t short_run_seed = 0xA0000000u;

/// Runs both estimators in turns until a look (see runs_of_look) gives a verdict, or until time or
/// runs are at their end; then the runs so far get one last look. `say` hears of every look.
[[nodiscard]] Study run_study(const RunSource& tested, const RunSource& reference,
                              const StudyParams& params,
                              const std::function<void(const std::string&)>& say = {});

}  // namespace mote
