// First events of shared paths, drawn by what is known of the light there: the same events in the
// mean, whatever that says.
#include <gtest/gtest.h>

#include "multiscatter/sharing.h"
#include "render/indirect_pass.h"
#include "render/one_pass.h"
#include "verify/statistics.h"

namespace mote {
namespace {

constexpr double alarm = 1e-5;  // false alarms, each comparison

enum class Says {
    Nothing,   ///< there is no guide
    Black,     ///< no light anywhere
    Even,      ///< everywhere the same
    Anything,  ///< at each node something else, at half of them nothing
    OneSided,  ///< nothing but on the side of the camera
};

MeanRadiance guide_that(Says says, const Media& media)
{
    MeanRadiance guide;
    guide.lattice = make_smoke_lattice(media, 0.1f, 4096);
    guide.values.assign(guide.lattice.nodes.size(), Spectrum(says == Says::Even ? 3.0f : 0.0f));
    Rng rng(3, 0, Stream::Test, 0, 0);
    for (size_t slot = 1; slot < guide.values.size(); ++slot) {
        const float value = 1e3f * std::max(0.0f, rng.uniform() - 0.5f);
        const bool is_near = 2 * guide.lattice.nodes[slot].z > guide.lattice.count.z;
        if (says == Says::Anything) guide.values[slot] = Spectrum(value);
        if (says == Says::OneSided) guide.values[slot] = Spectrum(is_near ? 1.0f : 0.0f);
    }
    return guide;
}

/// Over passes of one pixel: what its events weigh, and weigh times their distance.
struct Events {
    RunningStats weight;
    RunningStats moment;
    double most = 0.0;  ///< heaviest event
};

/// `is_wrong`: events keep the weight that they would have without a guide.
Events events_by(Says says, bool is_wrong = false)
{
    test::Pass pass(test::cloud(4.0f, 0.3f), 1, 1);
    pass.render.path.max_bounces = 4;
    const MeanRadiance guide = guide_that(says, pass.scene.media);
    PathSharing sharing;
    if (says != Says::Nothing) sharing.guide = &guide;
    pass.inputs.sharing = &sharing;
    Events events;
    std::vector<PathVertex> first;
    for (uint32_t n = 0; n < 4000; ++n) {
        const PassKey key{pass.scene.camera.width / 2, pass.scene.camera.height / 2, n};
        PixelDomain domain;
        PassCounts counts;
        make_pixel_domain(pass.domain, camera_ray(pass.inputs, key), domain, counts.bins);
        FilmSample sample;
        first.clear();
        add_indirect(pass.inputs, key, domain, nullptr, 0, first, sample, counts);
        double weight = 0.0;
        double moment = 0.0;
        for (const PathVertex& v : first) {
            const float own = max_component(v.weight) * (is_wrong ? v.drawn : 1.0f);
            weight += static_cast<double>(own);
            moment += static_cast<double>(own * glm::length(v.x - domain.ray.o));
            events.most = std::max(events.most, static_cast<double>(own));
            // Of each vertex as many paths are due.
            EXPECT_NEAR(v.drawn * max_component(v.weight),
                        first[0].drawn * max_component(first[0].weight), 1e-4f);
        }
        EXPECT_FALSE(first.empty());
        events.weight.add(weight);
        events.moment.add(moment);
    }
    return events;
}

TEST(GuidedEventsStat, TheSameInTheMeanWhateverTheGuideSays)
{
    const Events plain = events_by(Says::Nothing);
    for (const Says says : {Says::Black, Says::Even, Says::Anything, Says::OneSided}) {
        const Events guided = events_by(says);
        EXPECT_GT(welch_test(estimate_mean(guided.weight), estimate_mean(plain.weight)).p, alarm)
            << static_cast<int>(says);
        EXPECT_GT(welch_test(estimate_mean(guided.moment), estimate_mean(plain.moment)).p, alarm)
            << static_cast<int>(says);
        EXPECT_LT(guided.most, 6.0 * plain.most);  // a fifth of the mean counts everywhere
    }
    const Events wrong = events_by(Says::OneSided, true);
    EXPECT_LT(welch_test(estimate_mean(wrong.moment), estimate_mean(plain.moment)).p, alarm);
}

}  // namespace
}  // namespace mote
