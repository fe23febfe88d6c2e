#include "restir/small_reuse.h"

#include <cmath>

namespace mote::test {
namespace {

float visibility_of(const FrameDomain& frame, const Candidate& c, float time)
{
    return std::exp(-optical_depth(frame.scene->media, Ray{c.x, c.arrival.wi, time},
                                   {0.0f, c.arrival.distance}));
}

/// Target of a sample in a domain, its shadow included.
float target_of(const FrameDomain& frame, const PixelDomain& domain, const PathSample& y)
{
    const Candidate c = evaluate(frame, domain, y);
    const float p_hat = luminance(c.f);
    return p_hat > 0.0f ? p_hat * visibility_of(frame, c, domain.ray.time) : 0.0f;
}

float density_at(const FrameDomain& frame, const PixelDomain& domain, float u)
{
    return sigma_t_at(frame.scene->media, point_at(frame, domain, u).x, domain.ray.time);
}

}  // namespace

void SmallRun::draw(const SmallFrame& now, int index, SmallPixel& pixel) const
{
    const PixelDomain& domain = now.pixels[static_cast<size_t>(index)];
    Rng numbers = rng(now, index, 0);
    std::vector<Candidate> candidates;
    draw_candidates(now.frame, domain, how_.candidates, numbers, candidates);
    std::vector<float> visibility;
    for (Candidate& c : candidates) {
        visibility.push_back(visibility_of(now.frame, c, domain.ray.time));
        c.f *= visibility.back();
    }
    pixel.reservoir = resample(candidates, numbers, pixel.own_color);
    pixel.color = pixel.own_color;
    for (size_t i = 0; i < candidates.size(); ++i) {
        if (candidates[i].y.u == pixel.reservoir.r.y.u) pixel.visibility = visibility[i];
    }
}

void SmallRun::combine(const SmallFrame& now, const PixelDomain& own,
                       const std::vector<Other>& others, Rng& numbers, SmallPixel& pixel) const
{
    const Fault fault = how_.fault;
    const PixelReservoir mine = pixel.reservoir;
    Confidences c{mine.r.M, 0.0f};
    for (const Other& other : others) c.others += other.confidence;
    RisStream stream;
    stream.count(c.sum());
    const ShiftEnd here{now.frame, own};
    Spectrum color(0.0f);
    float m_0 = c.own / c.sum();
    PixelReservoir chosen;
    float chosen_visibility = pixel.visibility;
    for (const Other& other : others) {
        const PixelReservoir& theirs = other.pixel.reservoir;
        const ShiftEnd there{other.frame.frame, other.domain};
        // What the other could have made of the own sample.
        float own_there = 0.0f;
        PixelDomain current;
        ShiftEnd judged = there;
        if (fault == Fault::CurrentAsPrevious) {
            BinCounts counts;
            make_pixel_domain(now.frame, other.domain.ray, current, counts);
            if (!current.bins.empty()) weigh_bins(now.frame, current);
        }
        const ShiftEnd now_there{now.frame, current};
        const ShiftEnd& judge = fault == Fault::CurrentAsPrevious ? now_there : judged;
        if (mine.r.W > 0.0f) {
            const auto back = shift(how_.shift, mine.r.y, here, judge, other.map.inverse());
            if (back) {
                own_there = target_of(judge.frame, judge.domain, back->y) *
                            (fault == Fault::NoJacobian ? 1.0f : back->jacobian);
            }
        }
        m_0 += own_weight_term(how_.mis, c, other.confidence, own_there, mine.r.p_hat);

        // The other's sample here.
        const float u = numbers.uniform();
        if (!(theirs.r.W > 0.0f)) continue;
        const auto shifted = shift(how_.shift, theirs.r.y, there, here, other.map);
        if (!shifted) continue;
        const float jacobian = fault == Fault::NoJacobian ? 1.0f : shifted->jacobian;
        const Candidate candidate = evaluate(now.frame, own, shifted->y);
        if (!(luminance(candidate.f) > 0.0f)) continue;
        Spectrum f = candidate.f;
        const float visibility = fault == Fault::DonorVisibility
                                     ? other.pixel.visibility
                                     : visibility_of(now.frame, candidate, own.ray.time);
        f *= visibility;
        if (fault == Fault::DonorTarget) f = theirs.f;
        if (fault == Fault::DonorNormalisation) {
            f *= point_at(there.frame, there.domain, theirs.r.y.u).weight /
                 point_at(here.frame, here.domain, shifted->y.u).weight;
        }
        const float p_hat = luminance(f);
        const float m =
            other_weight(how_.mis, c, other.confidence, theirs.r.p_hat / jacobian, p_hat);
        const float weight = m * theirs.r.W * jacobian;
        color += weight * f;
        if (stream.add(shifted->y, p_hat, static_cast<double>(weight * p_hat), 0.0f, u)) {
            chosen.f = f;
            chosen_visibility = visibility;
        }
    }
    if (mine.r.W > 0.0f) {
        color += (m_0 * mine.r.W) * mine.f;
        const double w = static_cast<double>(m_0 * mine.r.p_hat * mine.r.W);
        if (stream.add(mine.r.y, mine.r.p_hat, w, 0.0f, numbers.uniform())) {
            chosen.f = mine.f;
            chosen_visibility = pixel.visibility;
        }
    }
    pixel.reservoir = {stream.finish(), chosen.f};
    pixel.color = color;
    pixel.visibility = chosen_visibility;
    if (fault == Fault::ScaledW) {
        pixel.reservoir.r.W *= 1.01f;
        pixel.color *= 1.01f;
    }
}

void SmallRun::reuse_history(const SmallFrame& before, const std::vector<SmallPixel>& history,
                             const SmallFrame& now, int index, SmallPixel& pixel) const
{
    const PixelDomain& own = now.pixels[static_cast<size_t>(index)];
    if (!(own.Z() > 0.0f)) return;
    std::optional<PreviousPixel> from = previous_pixel(before.frame, now.frame, own, true);
    const Reservoir& mine = pixel.reservoir.r;
    if (how_.fault == Fault::OwnSampleMotion && mine.W > 0.0f) {
        const Vec3 x = point_at(now.frame, own, mine.y.u).x;
        const auto film = project(before.frame.scene->camera, x, own.ray.time);
        if (film) from = PreviousPixel{static_cast<int>(film->x), static_cast<int>(film->y), {}};
        if (from->x >= now.width || from->y >= now.height) from.reset();
    }
    if (!from) return;
    const size_t there = static_cast<size_t>(from->y) * static_cast<size_t>(now.width) +
                         static_cast<size_t>(from->x);
    const PixelDomain& earlier = before.pixels[there];
    const Reservoir& theirs = history[there].reservoir.r;
    const RayMap map = make_ray_map(earlier.ray, own.ray, from->motion);
    if (how_.fault == Fault::SumKept) {
        // Weight sums of both, as if they were of one frame.
        const float sum = mine.W * mine.p_hat * mine.M + theirs.W * theirs.p_hat * theirs.M;
        const float M = std::min(mine.M + theirs.M, 20.0f);
        Rng numbers = rng(now, index, 1);
        const bool takes_own = numbers.uniform() * sum < mine.W * mine.p_hat * mine.M;
        SmallPixel out = takes_own ? pixel : history[there];
        Reservoir& r = out.reservoir.r;
        r.M = M;
        r.W = r.p_hat > 0.0f ? sum / (M * r.p_hat) : 0.0f;
        out.color = r.W * out.reservoir.f;
        out.own_color = pixel.own_color;
        pixel = out;
        return;
    }
    if (how_.fault == Fault::OneSidedRejection && theirs.W > 0.0f) {
        const auto shifted =
            shift(ShiftKind::World, theirs.y, {before.frame, earlier}, {now.frame, own}, map);
        const float was = density_at(before.frame, earlier, theirs.y.u);
        const float is = shifted ? density_at(now.frame, own, shifted->y.u) : 0.0f;
        if (std::abs(was - is) > 0.2f * std::max(was, is)) return;
    }
    if (how_.fault == Fault::EmptyIsNoInput && !(theirs.W > 0.0f)) return;
    Rng numbers = rng(now, index, 1);
    combine(now, own, {{before, earlier, history[there], std::min(theirs.M, how_.cap), map}},
            numbers, pixel);
}

void SmallRun::reuse_neighbours(const SmallFrame& now, const std::vector<SmallPixel>& pixels,
                                int index, SmallPixel& out) const
{
    const PixelDomain& own = now.pixels[static_cast<size_t>(index)];
    if (!(own.Z() > 0.0f)) return;
    Rng numbers = rng(now, index, 2);
    std::vector<Other> others;
    for (int i = 0; i < how_.neighbours; ++i) {
        const int x = index % now.width + static_cast<int>(5.0f * numbers.uniform()) - 2;
        const int y = index / now.width + static_cast<int>(5.0f * numbers.uniform()) - 2;
        const int there = y * now.width + x;
        if (x < 0 || y < 0 || x >= now.width || y >= now.height || there == index) continue;
        const auto at = static_cast<size_t>(there);
        const Reservoir& theirs = pixels[at].reservoir.r;
        if (how_.fault == Fault::EmptyIsNoInput && !(theirs.W > 0.0f)) continue;
        others.push_back({now, now.pixels[at], pixels[at], theirs.M,
                          make_ray_map(now.pixels[at].ray, own.ray, Vec3(0.0f))});
    }
    combine(now, own, others, numbers, out);
}

std::vector<SmallPixel> SmallRun::play(const std::vector<SmallFrame>& frames)
{
    std::vector<SmallPixel> history;
    std::vector<SmallPixel> pixels;
    for (size_t f = 0; f < frames.size(); ++f) {
        const SmallFrame& now = frames[f];
        const int count = now.width * now.height;
        pixels.assign(static_cast<size_t>(count), {});
        for (int i = 0; i < count; ++i) {
            SmallPixel& pixel = pixels[static_cast<size_t>(i)];
            draw(now, i, pixel);
            if (how_.temporal && f > 0) reuse_history(frames[f - 1], history, now, i, pixel);
        }
        history = pixels;
        if (how_.neighbours == 0) continue;
        for (int i = 0; i < count; ++i) {
            reuse_neighbours(now, history, i, pixels[static_cast<size_t>(i)]);
        }
    }
    return pixels;
}

}  // namespace mote::test
