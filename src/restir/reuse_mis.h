#pragma once

#include <algorithm>

#include "scene/restir_params.h"

namespace mote {

/// Confidences of one combination: the pixel's own reservoir and all others together.
struct Confidences {
    float own = 1.0f;
    float others = 0.0f;

    [[nodiscard]] float sum() const { return own + others; }
};

/// Which of the weights below a combination uses; one form for all its inputs.
enum class MisForm { Pairwise, Balance, Contribution, Constant };

/// Resampling MIS weights of a pixel's own sample (index 0) and of `n` others, each a partition of
/// unity at every sample y:
///   Pairwise  A_i(y) = k p_i / (k p_i + c_0 p_0), at most p_i / p_0, k the others' confidence;
///             m_i = c_i / C * A_i,  m_0 = c_0 / C + sum_j c_j / C * (1 - A_j).
///             Defensive; the bound keeps one input's weight from exploding where targets differ.
///   Balance   m_i = c_i p_i / sum_j c_j p_j, the generalised balance heuristic: needs all inputs'
///             targets at every sample, so its cost is quadratic in their number.
///   Constant  m_i = c_i / C: biased where an input cannot produce y.
///   Contribution  chooses by Constant, then the chosen sample's W counts C / Z times, Z the
///             confidence of the inputs that could have produced it: unbiased, linear, noisier.
/// p_0 and p_i are targets at y: the pixel's own, and the other's pulled back to the pixel
/// (Jacobian included, 0 where undefined). After the defensive pairwise MIS of Bitterli 2022 and
/// Lin et al. 2022; Balance: Talbot 2005, Lin et al. 2022; Contribution: the 1/Z of Bitterli et al.
/// 2020, Alg. 6, with confidences.
[[nodiscard]] inline float pairwise_share(const Confidences& c, float p_other, float p_own)
{
    const double other = static_cast<double>(c.others) * static_cast<double>(p_other);
    const double own = static_cast<double>(c.own) * static_cast<double>(p_own);
    if (!(other > 0.0)) return 0.0f;
    const double bound =
        static_cast<double>(p_other) / std::max(static_cast<double>(p_own), 1e-300);
    return static_cast<float>(std::min(other / (other + own), bound));
}

/// m_i of another input at its own sample; not for Balance.
[[nodiscard]] inline float other_weight(MisForm form, const Confidences& c, float c_other,
                                        float p_other, float p_own)
{
    const float share = c_other / c.sum();
    return form == MisForm::Pairwise ? share * pairwise_share(c, p_other, p_own) : share;
}

/// What another input leaves of m_0 at the pixel's own sample: m_0 = c_0 / C + sum of these; not
/// for Balance.
[[nodiscard]] inline float own_weight_term(MisForm form, const Confidences& c, float c_other,
                                           float p_other, float p_own)
{
    if (form != MisForm::Pairwise) return 0.0f;
    return c_other / c.sum() * (1.0f - pairwise_share(c, p_other, p_own));
}

/// Confidence times target, summed over all inputs at one sample: the denominator of Balance.
struct TargetSum {
    double sum = 0.0;

    void add(float confidence, float p)
    {
        sum += static_cast<double>(confidence) * static_cast<double>(p);
    }
    /// The weight of an input that is part of the sum; 0 where nobody can have made the sample.
    [[nodiscard]] float share(float confidence, float p) const
    {
        if (!(p > 0.0f)) return 0.0f;
        return static_cast<float>(static_cast<double>(confidence) * static_cast<double>(p) / sum);
    }
};

/// Whether the weight of the pixel's own sample depends on the others' targets there.
[[nodiscard]] inline bool compares_targets(MisForm form)
{
    return form == MisForm::Pairwise || form == MisForm::Balance;
}

}  // namespace mote
