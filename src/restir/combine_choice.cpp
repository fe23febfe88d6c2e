#include <cmath>

#include "restir/combine.h"

namespace mote {

Confidences Combination::confidences(const Pixel& pixel) const
{
    Confidences c{pixel.own->r.M, 0.0f};
    for (size_t i = 0; i < pixel.count; ++i) c.others += others_[pixel.first + i].M;
    return c;
}

float Combination::own_weight(const Pixel& pixel, const Confidences& c) const
{
    const float p_hat = pixel.own->r.p_hat;
    if (rules_.mis == MisForm::Balance) {
        TargetSum all;
        all.add(c.own, p_hat);
        for (size_t i = 0; i < pixel.count; ++i) {
            const Other& other = others_[pixel.first + i];
            all.add(other.M, other.own_there);
        }
        return all.share(c.own, p_hat);
    }
    float m = c.own / c.sum();
    for (size_t i = 0; i < pixel.count; ++i) {
        const Other& other = others_[pixel.first + i];
        m += own_weight_term(rules_.mis, c, other.M, other.own_there, p_hat);
    }
    return m;
}

float Combination::weight_of(const Pixel& pixel, size_t i, const Confidences& c, float p_hat) const
{
    const Other& other = others_[pixel.first + i];
    if (rules_.mis != MisForm::Balance) {
        return other_weight(rules_.mis, c, other.M, other.pulled_back(), p_hat);
    }
    TargetSum all;
    all.add(c.own, p_hat);
    for (size_t j = 0; j < pixel.count; ++j) {
        all.add(others_[pixel.first + j].M,
                j == i ? other.pulled_back() : targets_[pixel.first_cross + i * pixel.count + j]);
    }
    return all.share(other.M, other.pulled_back());
}

Combination::Choice Combination::select(const Pixel& pixel, Rng& rng) const
{
    const Reservoir& mine = pixel.own->r;
    const Confidences c = confidences(pixel);
    RisStream stream;
    stream.count(c.sum());
    Choice choice;
    choice.which = pixel.count;
    float V = 1.0f;
    double visible_sum = 0.0;

    const float m_0 = own_weight(pixel, c);
    const double w_0 =
        static_cast<double>(m_0) * static_cast<double>(mine.p_hat) * static_cast<double>(mine.W);
    if (mine.W > 0.0f && m_0 > 0.0f) {
        choice.color += (m_0 * mine.V * mine.W) * pixel.own->f;
        visible_sum += static_cast<double>(mine.V) * w_0;
    }
    if (stream.add(mine.y, mine.p_hat, w_0, mine.age, rng.uniform())) {
        choice.out.f = pixel.own->f;
        V = mine.V;
    }
    for (size_t i = 0; i < pixel.count; ++i) {
        const Other& other = others_[pixel.first + i];
        const float p_hat = other.p_hat();
        const float u = rng.uniform();
        if (!(p_hat > 0.0f)) continue;  // so where the shift is undefined
        const float m = weight_of(pixel, i, c, p_hat);
        const float weight = m * other.W * other.jacobian;
        if (!std::isfinite(weight)) continue;
        const Spectrum f = other.shadow * other.f;
        choice.color += (other.V * weight) * f;
        const double w = static_cast<double>(weight) * static_cast<double>(p_hat);
        visible_sum += static_cast<double>(other.V) * w;
        if (stream.add(other.y, p_hat, w, other.age, u)) {
            choice.out.f = f;
            choice.which = i;
            V = other.V;
        }
    }
    choice.out.r = stream.finish();
    if (rules_.averages_V && stream.choice.w_sum > 0.0)
        V = static_cast<float>(visible_sum / stream.choice.w_sum);
    choice.out.r.V = V;
    return choice;
}

void Combination::choose(Rng& rng)
{
    Pixel& pixel = pixels_[chosen_.size()];
    MOTE_ASSERT(sites_.size() == others_.size());
    const Choice& choice = chosen_.emplace_back(select(pixel, rng));
    pixel.first_cross = targets_.size();
    targets_.resize(targets_.size() + pixel.count, 0.0f);
    if (!(choice.out.r.W > 0.0f)) return;
    for (size_t j = 0; j < pixel.count; ++j) {
        if (j != choice.which) ask_target(choice.out.r.y, pixel.first + j, pixel.first_cross + j);
    }
}

void Combination::trace_chosen(const Scene& there, WalkCounts& counts)
{
    trace_targets(there, counts);
}

PixelReservoir Combination::finish(int index, Rng& rng, Spectrum& color) const
{
    const Pixel& pixel = pixels_[static_cast<size_t>(index)];
    if (!chooses_first()) {
        const Choice choice = select(pixel, rng);
        const Reservoir& r = choice.out.r;
        color = rules_.shades_all ? choice.color : (r.V * r.W) * choice.out.f;
        return choice.out;
    }
    const Choice& choice = chosen_[static_cast<size_t>(index)];
    PixelReservoir out = choice.out;
    float Z = pixel.own->r.M;
    for (size_t j = 0; j < pixel.count; ++j) {
        const bool can_make_it = j == choice.which || targets_[pixel.first_cross + j] > 0.0f;
        if (can_make_it) Z += others_[pixel.first + j].M;
    }
    out.r.W *= confidences(pixel).sum() / Z;
    color = (out.r.V * out.r.W) * out.f;
    return out;
}

}  // namespace mote
