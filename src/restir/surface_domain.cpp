#include "restir/surface_domain.h"

#include <algorithm>

#include "surfaces/bsdf.h"

namespace mote {
namespace {

/// Passes go on to sample surfaces of which less light than this arrives only so often.
constexpr float dim = 0.05f;

}  // namespace

SurfaceDomain make_surface_domain(const FrameDomain& frame, const PixelDomain& domain, float u)
{
    MOTE_ASSERT(domain.surface.has_value());
    SurfaceDomain out;
    out.v = make_vertex(*frame.scene->surfaces, *domain.surface, domain.ray.time);
    out.wo = domain.wo();
    out.time = domain.ray.time;
    out.distance = domain.surface->t;
    const float T = std::exp(-domain.bins.depth());
    const float goes_on = std::min(1.0f, T / dim);
    out.share = u < goes_on ? T / goes_on : 0.0f;
    return out;
}

float light_surface(const SurfaceDomain& domain, const Arrival& arrival, Candidate& c)
{
    const BsdfValue bsdf = eval_bsdf_and_pdf(domain.v, domain.wo, arrival.wi);
    const Spectrum f = bsdf.cosine * bsdf.f * arrival.L;
    if (!is_finite(f) || !(max_component(f) > 0.0f)) return bsdf.pdf_dir;
    c.x = ray_origin(domain.v, arrival.wi);
    c.arrival = arrival;
    if (arrival.distance < infinity) {
        // From where the ray really starts to where it is to end.
        const Vec3 to_light = domain.v.p + arrival.distance * arrival.wi - c.x;
        const float distance = glm::length(to_light);
        if (!(distance > 0.0f)) return bsdf.pdf_dir;
        c.arrival.wi = to_light / distance;
        c.arrival.distance = distance;
    }
    c.f = f;
    return bsdf.pdf_dir;
}

Candidate evaluate(const FrameDomain& frame, const SurfaceDomain& domain, const PathSample& y)
{
    Candidate c;
    c.y = y;
    c.x = domain.v.p;
    const std::optional<Arrival> arrival = light_at(frame, y, domain.v.p, domain.time);
    if (arrival) light_surface(domain, *arrival, c);
    return c;
}

}  // namespace mote
