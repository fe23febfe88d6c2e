#pragma once

namespace mote {

/// What is asked of a study, and how sure its answer must be.
struct Question {
    /// Bias worth finding in the mean of the whole image, relative: (0, 1). See channel_scale.
    double budget = 0.01;
    /// The same for the mean of a single tile. A hundredth of it is called bias in no tile.
    double tile_budget = 0.1;
    /// Chance of BiasFound without bias; under `equivalence` also that of NoBias for a bias of the
    /// budget or more. Holds for all looks, tiles and channels together.
    double alpha = 0.01;
    /// Chance that a bias of the budget is found, at the look that says NoBias.
    double power = 0.9;
    /// For estimators that are biased and known to be: NoBias if |bias| < budget is shown in every
    /// channel of the whole image, BiasFound if |bias| > budget is shown in one. Too few runs show
    /// neither. Otherwise NoBias says that "no bias at all" stands, though a bias of the budget
    /// would have been found.
    bool equivalence = false;
};

}  // namespace mote
