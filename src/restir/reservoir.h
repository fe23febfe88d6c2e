#pragma once

#include "restir/path_sample.h"

namespace mote {

/// Finished reservoir of one pixel. W estimates 1/p(y): E[f(y) W] is the integral of f.
struct Reservoir {
    PathSample y;        ///< selected sample
    float p_hat = 0.0f;  ///< target function at y, in this pixel's domain
    float W = 0.0f;      ///< unbiased contribution weight; 0 = empty
    float M = 0.0f;      ///< confidence [passes]: 1 when fresh, whatever its candidate count
    float age = 0.0f;    ///< passes since y was drawn
    /// What p_hat leaves out of y's visibility, as far as it is known [0,1]: 1 where targets know
    /// shadows.
    float V = 1.0f;
};
static_assert(sizeof(Reservoir) <= 48);

/// One of a stream of things, chosen in proportion to their weights.
struct WeightedChoice {
    double w_sum = 0.0;

    /// Whether the new one takes the place of the one chosen so far; u in [0,1). A weight that is
    /// not above 0 (or not finite) is never chosen.
    bool add(double w, float u)
    {
        if (!(w > 0.0) || !std::isfinite(w)) return false;
        w_sum += w;
        return static_cast<double>(u) * w_sum < w;
    }
};

/// Weighted reservoir being filled. Streaming RIS: Bitterli et al. 2020, Alg. 3.
struct RisStream {
    PathSample y;
    float p_hat_y = 0.0f;
    float age_y = 0.0f;
    WeightedChoice choice;
    float M = 0.0f;

    /// w is the full resampling weight, MIS factor and Jacobian included. u in [0,1).
    /// M is counted apart: see `count`.
    bool add(const PathSample& x, float p_hat, double w, float age, float u)
    {
        if (!choice.add(w, u)) return false;
        y = x;
        p_hat_y = p_hat;
        age_y = age;
        return true;
    }

    /// Confidence of an input counts whether or not it brought a sample: an empty input says that
    /// there is little light.
    void count(float confidence) { M += confidence; }

    [[nodiscard]] Reservoir finish() const
    {
        const double W = p_hat_y > 0.0f ? choice.w_sum / static_cast<double>(p_hat_y) : 0.0;
        return {y, p_hat_y, static_cast<float>(W), M, age_y, 1.0f};
    }
};

}  // namespace mote
