#include "restir/lobe_hats.h"

namespace mote {
namespace {

float hg_share(float one_minus_cos, float one_plus_cos, float g)
{
    // From the antiderivative (1 - g^2) / (2 g sqrt(1 + g^2 - 2 g cos)), with g divided out.
    const float a = std::abs(g);
    const float off_peak = g < 0.0f ? one_plus_cos : one_minus_cos;
    const float root = std::sqrt(sqr(1.0f - a) + 2.0f * a * off_peak);
    return std::min(1.0f, (1.0f + g) * one_minus_cos / (root * (root + 1.0f - g)));
}

/// Cosine at which phase_share is u, by bisection.
float cosine_at_share(const Phase& phase, float u)
{
    float lo = -1.0f;  // where the share is 1
    float hi = 1.0f;
    for (int i = 0; i < 30; ++i) {
        const float middle = 0.5f * (lo + hi);
        (phase_share(phase, 1.0f - middle, 1.0f + middle) > u ? lo : hi) = middle;
    }
    return 0.5f * (lo + hi);
}

}  // namespace

float phase_share(const Phase& phase, float one_minus_cos, float one_plus_cos)
{
    const float a = hg_share(one_minus_cos, one_plus_cos, phase.g);
    if (phase.weight_b == 0.0f) return a;
    return a + phase.weight_b * (hg_share(one_minus_cos, one_plus_cos, phase.g_b) - a);
}

Mat3 FrameField::at(Vec3 d) const
{
    const Vec3 n = d * base_;
    // make_frame without its seam at n.z = 0; rounding spoils it near n.z = -1.
    if (n.z < -0.9f) return base_ * make_frame(n);
    const float a = -1.0f / (1.0f + n.z);
    const float b = n.x * n.y * a;
    return base_ *
           Mat3(Vec3(1.0f + n.x * n.x * a, b, -n.x), Vec3(b, 1.0f + n.y * n.y * a, -n.y), n);
}

LobeHats::LobeHats(const Phase& phase, const DirectionHats& shape) : phase_(phase), shape_(shape)
{
    for (int i = 0; i < shape.bands; ++i) {
        const float u = (static_cast<float>(i) + 0.5f) / static_cast<float>(shape.bands);
        const float cosine = cosine_at_share(phase, u);
        const float sine = std::sqrt(1.0f - cosine * cosine);
        for (int j = 0; j < shape.azimuths; ++j) {
            const float v = (static_cast<float>(j) + 0.5f) / static_cast<float>(shape.azimuths);
            const float angle = 2.0f * pi * v;
            centres_.emplace_back(sine * std::cos(angle), sine * std::sin(angle), cosine);
        }
    }
}

DirectionHats::Weights LobeHats::at(const Mat3& frame, Vec3 wi) const
{
    const float turns =
        std::atan2(glm::dot(frame[1], wi), glm::dot(frame[0], wi)) * (0.5f * inv_pi);
    // By the chords: lengths that are 1 only to rounding would show in narrow lobes.
    const Vec3 ahead = wi - frame[2];
    const Vec3 behind = wi + frame[2];
    return shape_.at_square(
        phase_share(phase_, 0.5f * glm::dot(ahead, ahead), 0.5f * glm::dot(behind, behind)), turns);
}

}  // namespace mote
