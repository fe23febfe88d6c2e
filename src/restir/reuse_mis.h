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
enum class MisForm { Pairwise, Balance, Constant };

/// Resampling MIS weights of a pixel's own sample (index 0) and of `n` others, each a partition of
/// unity at every sample y:
///   Pairwise  A_i(y) = k p_i / (k p_i + c_0 p_0), at most p_i / p_0, k the others' confidence;
///             m_i = c_i / C * A_i,  m_0 = c_0 / C + sum_j c_j / C * (1 - A_j).
///             Defensive; the bound keeps one input's weight from exploding where targets differ.
///   Balance   of one other input: m_1 = c_1 p_1 / (c_1 p_1 + c_0 p_0), m_0 = 1 - m_1.
///   Constant  m_i = c_i / C: biased where an input cannot produce y.
/// p_0 and p_i are targets at y: the pixel's own, and the other's pulled back to the pixel
/// (Jacobian included, 0 where undefined). After the defensive pairwise MIS of Bitterli 2022 and
/// Lin et al. 2022.
[[nodiscard]] inline float pairwise_share(const Confidences& c, float p_other, float p_own)
{
    const double other = static_cast<double>(c.others) * static_cast<double>(p_other);
    const double own = static_cast<double>(c.own) * static_cast<double>(p_own);
    if (!(other > 0.0)) return 0.0f;
    const double bound =
        static_cast<double>(p_other) / std::max(static_cast<double>(p_own), 1e-300);
    return static_cast<float>(std::min(other / (other + own), bound));
}

/// m_i of another input at its own sample.
[[nodiscard]] inline float other_weight(MisForm form, const Confidences& c, float c_other,
                                        float p_other, float p_own)
{
    switch (form) {
        case MisForm::Pairwise:
            return c_other / c.sum() * pairwise_share(c, p_other, p_own);
        case MisForm::Balance: {
            const float other = c_other * p_other;
            return other > 0.0f ? other / (other + c.own * p_own) : 0.0f;
        }
        case MisForm::Constant:
            return c_other / c.sum();
    }
    return 0.0f;
}

/// What another input leaves of m_0 at the pixel's own sample: m_0 = base + sum of these.
[[nodiscard]] inline float own_weight_base(MisForm form, const Confidences& c)
{
    return form == MisForm::Balance ? 1.0f : c.own / c.sum();
}
[[nodiscard]] inline float own_weight_term(MisForm form, const Confidences& c, float c_other,
                                           float p_other, float p_own)
{
    switch (form) {
        case MisForm::Pairwise:
            return c_other / c.sum() * (1.0f - pairwise_share(c, p_other, p_own));
        case MisForm::Balance:
            return -other_weight(form, c, c_other, p_other, p_own);
        case MisForm::Constant:
            return 0.0f;
    }
    return 0.0f;
}

}  // namespace mote
