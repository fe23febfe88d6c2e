#include "restir/edge_weights.h"

#include <algorithm>

namespace mote {
namespace {

constexpr float thin = 0.5f;  ///< depth below which the closed form cancels

/// linear_weights() in lanes. Series up to the seventh power: 4e-7 at `thin`.
struct LaneWeights {
    Float8 near, far;

    [[gnu::always_inline]] explicit LaneWeights(const Float8& D)
    {
        const Float8 thin_near =
            D * (0.5f -
                 D * (1.0f / 6 -
                      D * (1.0f / 24 - D * (1.0f / 120 -
                                            D * (1.0f / 720 - D * (1.0f / 5040 - D / 40320.0f))))));
        const Float8 thin_far =
            D * (0.5f -
                 D * (1.0f / 3 -
                      D * (1.0f / 8 -
                           D * (1.0f / 30 - D * (1.0f / 144 - D * (1.0f / 840 - D / 5760.0f))))));
        const Float8 kept = exp_of_negative(-D);
        const Float8 lost = 1.0f - kept;
        const Float8 thick_far = (lost - D * kept) / max(D, splat(thin));
        near = D < thin ? thin_near : lost - thick_far;
        far = D < thin ? thin_far : thick_far;
    }
};

}  // namespace

void weigh_edges(const RayBins& bins, EdgeWeights& out)
{
    constexpr int room = EdgeWeights::capacity + lane_count;
    const int count = bins.count;
    const int padded = (count + lane_count - 1) / lane_count * lane_count;
    float tau[room];
    float near[room];
    float far[room];
    std::copy_n(bins.tau, count + 1, tau);
    std::fill(tau + count + 1, tau + padded + 1, 0.0f);
    for (int k = 0; k < padded; k += lane_count) {
        const Float8 here = load(tau + k);
        const Float8 T = exp_of_negative(-here);
        const LaneWeights weights(max(load(tau + k + 1) - here, splat(0.0f)));
        store(near + k, T * weights.near);
        store(far + k, T * weights.far);
    }
    out.of[0] = near[0];
    for (int k = 1; k < count; ++k) out.of[k] = far[k - 1] + near[k];
    out.of[count] = far[count - 1];
}

}  // namespace mote
