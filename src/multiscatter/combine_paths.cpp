#include "multiscatter/combine_paths.h"

#include "restir/reservoir.h"

namespace mote {
namespace {

float target(Spectrum f)
{
    return luminance(f);
}

double weight_of(float m, float p_hat, float W)
{
    return static_cast<double>(m) * static_cast<double>(p_hat) * static_cast<double>(W);
}

/// Weight of the pixel's own path.
float own_weight(const PathPixel& own, std::span<const OtherPath> others, const Confidences& c,
                 MisForm form)
{
    if (form == MisForm::Balance) {
        TargetSum all;
        all.add(c.own, own.r.p_hat);
        for (const OtherPath& other : others) all.add(other.M, other.own_there);
        return all.share(c.own, own.r.p_hat);
    }
    float m = c.own / c.sum();
    for (const OtherPath& other : others) {
        m += own_weight_term(form, c, other.M, other.own_there, own.r.p_hat);
    }
    return m;
}

float weight_of_other(const OtherPath& other, const Confidences& c, MisForm form)
{
    const float pulled_back = other.p_hat_there / other.here.jacobian;
    const float p_hat = target(other.here.f);
    if (form != MisForm::Balance) return other_weight(form, c, other.M, pulled_back, p_hat);
    TargetSum all;
    all.add(c.own, p_hat);
    all.add(other.M, pulled_back);
    return all.share(other.M, pulled_back);
}

}  // namespace

PathPixel resample_paths(const PathEndpoint& own, std::span<const DrawnPath> paths, float share,
                         Rng& rng, Spectrum& color)
{
    PathPixel out;
    out.r.M = 1.0f;
    color = Spectrum(0.0f);
    WeightedChoice choice;
    const DrawnPath* chosen = nullptr;
    for (const DrawnPath& path : paths) {
        const Spectrum value = share * path.value;
        color += value;
        if (choice.add(static_cast<double>(target(value)), rng.uniform())) chosen = &path;
    }
    if (!chosen) return out;
    out.r.y = chosen->y;
    // Densities have cancelled so far, and random numbers have none; the target itself is needed of
    // the chosen path alone.
    out.f = chosen->y.form == PathForm::Replay ? chosen->value
                                               : eval_path(own.world, own.domain, chosen->y);
    out.r.p_hat = target(out.f);
    if (!(out.r.p_hat > 0.0f)) return out;
    out.r.W = static_cast<float>(choice.w_sum / static_cast<double>(out.r.p_hat));
    return out;
}

OtherPath make_other_path(const PathReservoir& mine, const PathEndpoint& own,
                          const PathReservoir& other, const PathEndpoint& from, float confidence,
                          const PathMap& map)
{
    OtherPath out;
    out.p_hat_there = other.p_hat;
    out.W = other.W;
    out.M = confidence;
    out.age = other.age;
    if (other.W > 0.0f) {
        if (const auto here = shift_path(other.y, from, own, map)) out.here = *here;
    }
    if (mine.W > 0.0f) {
        const auto there = shift_path(mine.y, own, from, map.inverse());
        if (there) out.own_there = there->jacobian * target(there->f);
    }
    return out;
}

PathPixel combine_paths(const PathPixel& own, std::span<const OtherPath> others, MisForm form,
                        Rng& rng, Spectrum& color)
{
    MOTE_ASSERT(form != MisForm::Contribution);
    MOTE_ASSERT(form != MisForm::Balance || others.size() <= 1);
    Confidences c{own.r.M, 0.0f};
    for (const OtherPath& other : others) c.others += other.M;
    PathPixel out;
    color = Spectrum(0.0f);
    WeightedChoice choice;
    const float m_0 = own_weight(own, others, c, form);
    color += m_0 * own.r.W * own.f;
    if (choice.add(weight_of(m_0, own.r.p_hat, own.r.W), rng.uniform())) out = own;
    for (const OtherPath& other : others) {
        const float u = rng.uniform();
        const float p_hat = target(other.here.f);
        if (!(p_hat > 0.0f)) continue;
        const float W = other.W * other.here.jacobian;
        const float m = weight_of_other(other, c, form);
        color += m * W * other.here.f;
        if (!choice.add(weight_of(m, p_hat, W), u)) continue;
        out.r.y = other.here.y;
        out.r.p_hat = p_hat;
        out.r.age = other.age;
        out.f = other.here.f;
    }
    out.r.M = c.sum();
    out.r.W = out.r.p_hat > 0.0f
                  ? static_cast<float>(choice.w_sum / static_cast<double>(out.r.p_hat))
                  : 0.0f;
    return out;
}

}  // namespace mote
