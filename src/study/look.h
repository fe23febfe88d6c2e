#pragma once

#include <string>
#include <vector>

#include "study/question.h"
#include "verify/tiles.h"

namespace mote {

enum class Verdict {
    NoBias,         ///< none found, and one of the budget would have been
    BiasFound,      ///< or pixels that are not finite
    NotEnoughRuns,  ///< to say either
};

[[nodiscard]] const char* verdict_name(Verdict verdict);

/// Share of alpha for the k-th look, k = 1, 2, ...: alpha / (k (k + 1)). These sum to alpha however
/// many looks there are, so that whoever stops at the first rejection is wrong with at most chance
/// alpha (Bonferroni over the looks, which may be as dependent as they like).
[[nodiscard]] double alpha_of_look(double alpha, int k);

/// Runs per side at the k-th look: first_look, then half as many again each time.
[[nodiscard]] int runs_of_look(int first_look, int k);

/// What one channel of the whole image shows. All relative to its scale.
struct ChannelBias {
    std::string name;
    double scale = 0.0;
    double bias = 0.0;
    double standard_error = 0.0;
    double p = 1.0;              ///< of no bias
    double detectable = 0.0;     ///< bias that this look's test finds with the power asked for
    double equivalence_p = 1.0;  ///< of a bias of the budget or more
    double excess_p = 1.0;       ///< of a bias of at most the budget
};

/// What is known after some runs of both estimators.
struct Look {
    int index = 1;
    int runs = 0;        ///< of each estimator
    double alpha = 0.0;  ///< spent at this look
    std::vector<ChannelBias> channels;
    RunComparison comparison;
    double detectable = 0.0;       ///< largest of the channels
    double tile_detectable = 0.0;  ///< of the typical tile: median of those that vary over the
                                   ///< runs, largest of R, G and B
    Verdict verdict = Verdict::NotEnoughRuns;
    std::string reason;  ///< of the verdict, one line
};

/// Fewest runs that any verdict is given for: means of fewer are far from normal.
inline constexpr int fewest_runs = 16;

/// Judges the runs so far. Both sets have equally many (asserted), and the channels R, G and B.
[[nodiscard]] Look judge(const TileStats& tested, const TileStats& reference,
                         const Question& question, int look_index);

}  // namespace mote
