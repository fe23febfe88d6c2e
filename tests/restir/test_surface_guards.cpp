// Surfaces' candidates at the edge of what floats can tell.
#include <gtest/gtest.h>

#include <cmath>

#include "core/rng.h"
#include "core/sampling.h"
#include "restir/domains.h"
#include "restir/incident_light.h"
#include "restir/room_scenes.h"
#include "restir/surface_domain.h"

namespace mote {
namespace {

const Vec3 wo(0.0f, 0.0f, 1.0f);

SurfaceDomain floor_at(Vec3 p)
{
    SurfaceDomain domain;
    domain.v.p = p;
    domain.v.offset = 1e-3f;
    domain.v.material = test::diffuse(Spectrum(0.5f));
    domain.wo = wo;
    domain.share = 1.0f;
    return domain;
}

TEST(SurfaceGuards, LightOnASurfaceIsFiniteAndHasADirection)
{
    const SurfaceDomain domain = floor_at(Vec3(0.0f));
    Candidate c;
    // Radiance over a density of almost 0.
    light_surface(domain, {wo, 1.0f, Spectrum(infinity)}, c);
    EXPECT_EQ(c.f, Spectrum(0.0f));
    // A light where shadow rays start.
    light_surface(domain, {wo, domain.v.offset, Spectrum(1.0f)}, c);
    EXPECT_EQ(c.f, Spectrum(0.0f));
    light_surface(domain, {wo, 1.0f, Spectrum(1.0f)}, c);
    EXPECT_GT(c.f.x, 0.0f);
    EXPECT_NEAR(glm::length(c.arrival.wi), 1.0f, 1e-6f);
}

/// What caches think dark stays likely next to surfaces.
TEST(SurfaceGuards, CandidatesAreNeverThoughtDark)
{
    Scene scene = test::courtyard(false);
    FrameDomain frame = test::candidates_domain(scene);
    LightCaches caches = *frame.caches;
    Media media = scene.media;
    media.volumes[0].density_scale = 1e4f;
    for (LightCaches::Distant& distant : caches.distant) {
        distant.map = std::make_shared<TransmittanceMap>(media, distant.direction);
    }
    frame.caches = std::make_shared<const LightCaches>(std::move(caches));
    const SurfaceDomain domain = floor_at(-1.2f * test::sun().direction);
    Rng rng(1, 0, Stream::Test, 0, 0);
    std::vector<Candidate> candidates;
    draw_surface_candidates(frame, domain, rng, candidates);
    ASSERT_FALSE(candidates.empty());
    for (const Candidate& c : candidates) EXPECT_GE(c.known, 0.25f);
}

/// Directions that meet lights where their own sampling hardly goes: rims, seen from next to them.
TEST(SurfaceGuards, CandidatesHaveADensity)
{
    Scene scene = test::room();
    RestirParams params;
    params.surface.bsdf_candidates = 16;
    const FrameDomain frame = test::make_domain(scene, params);
    std::vector<Candidate> candidates;
    for (uint32_t i = 0; i < 1000; ++i) {
        Rng rng(1, 0, Stream::Test, i, 0);
        SurfaceDomain domain = floor_at(Vec3(0.0f));
        // Right in front of the quad, flat to it.
        domain.v.p = Vec3(-1.5f + 1e-4f * rng.uniform(), -0.2f + 0.3f * rng.uniform(), -0.2f);
        domain.v.ng = domain.v.ns = Vec3(0.0f, 1.0f, 0.0f);
        domain.wo = Vec3(0.0f, 1.0f, 0.0f);
        candidates.clear();
        draw_surface_candidates(frame, domain, rng, candidates);
        for (const Candidate& c : candidates) {
            ASSERT_TRUE(c.density > 0.0f && std::isfinite(c.density)) << i << " " << c.density;
            ASSERT_TRUE(is_finite(c.f / c.density)) << i;
        }
    }
}

}  // namespace
}  // namespace mote
