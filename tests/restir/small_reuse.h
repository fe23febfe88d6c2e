#pragma once

#include <vector>

#include "restir/candidates.h"
#include "restir/combine.h"
#include "restir/pixel_domains.h"
#include "restir/reproject.h"
#include "restir/reuse_mis.h"
#include "restir/shift.h"

namespace mote::test {

/// Mistakes that renderers make. Each is known to be biased, so the tests must see it.
enum class Fault {
    None,
    NoJacobian,          ///< of the shift
    CurrentAsPrevious,   ///< the earlier domain's target from the smoke of now
    DonorTarget,         ///< another pixel's sample counts as it did there
    DonorVisibility,     ///< its shadow is not traced again
    DonorNormalisation,  ///< the other ray's weights between distances are kept
    EmptyIsNoInput,      ///< inputs without a sample are passed over
    OneSidedRejection,   ///< history is dropped if the density at its sample has changed
    OwnSampleMotion,     ///< the earlier pixel is found by the sample instead of pixel data
    ScaledW,             ///< W is 1 % too large
    SumKept,             ///< weights add up while M stops at 20, nothing is evaluated again
};

/// How a small renderer, written apart from the real one and as plainly as can be, reuses: pixel
/// centres, one pass per frame, one combination at a time, a ray per shadow. It shares draws,
/// evaluation, shifts and weights with the renderer, but neither its combination nor its passes.
struct SmallReuse {
    ShiftKind shift = ShiftKind::RandomNumbers;
    MisForm mis = MisForm::Pairwise;
    bool temporal = false;
    int neighbours = 0;
    int candidates = 4;
    float cap = 4.0f;
    Fault fault = Fault::None;
};

/// Frames as they are drawn from: one domain per pixel.
struct SmallFrame {
    FrameDomain frame;
    std::vector<PixelDomain> pixels;
    int width = 0;
    int height = 0;
};

[[nodiscard]] inline std::vector<SmallFrame> small_frames(const std::vector<Scene>& scenes,
                                                          const RestirParams& params = {})
{
    std::vector<SmallFrame> out;
    for (const Scene& scene : scenes) {
        SmallFrame frame{
            frame_domain_of(scene, params), {}, scene.camera.width, scene.camera.height};
        frame.pixels.resize(static_cast<size_t>(frame.width * frame.height));
        for (int i = 0; i < frame.width * frame.height; ++i) {
            make_domain(frame.frame, Vec2(i % frame.width, i / frame.width) + 0.5f,
                        frame.pixels[static_cast<size_t>(i)]);
        }
        out.push_back(std::move(frame));
    }
    return out;
}

/// A pixel's light with reuse and from its own candidates alone; the latter's mean is right.
struct SmallPixel {
    PixelReservoir reservoir;
    Spectrum color{0.0f};
    Spectrum own_color{0.0f};
    float visibility = 1.0f;  ///< of the reservoir's sample
};

/// One run of a small renderer.
class SmallRun {
  public:
    SmallRun(const SmallReuse& how, uint32_t seed) : how_(how), seed_(seed) {}

    /// Plays all frames; the last one's pixels.
    std::vector<SmallPixel> play(const std::vector<SmallFrame>& frames);

  private:
    struct Other {
        const SmallFrame& frame;
        const PixelDomain& domain;
        const SmallPixel& pixel;
        float confidence = 1.0f;
        RayMap map;
    };

    void draw(const SmallFrame& now, int index, SmallPixel& pixel) const;
    void reuse_history(const SmallFrame& before, const std::vector<SmallPixel>& history,
                       const SmallFrame& now, int index, SmallPixel& pixel) const;
    void reuse_neighbours(const SmallFrame& now, const std::vector<SmallPixel>& pixels, int index,
                          SmallPixel& out) const;
    void combine(const SmallFrame& now, const PixelDomain& own, const std::vector<Other>& others,
                 Rng& rng, SmallPixel& pixel) const;
    [[nodiscard]] Rng rng(const SmallFrame& now, int index, uint32_t purpose) const
    {
        return {seed_, static_cast<uint32_t>(now.frame.scene->frame), Stream::Test,
                static_cast<uint32_t>(index), purpose};
    }

    SmallReuse how_;
    uint32_t seed_;
};

}  // namespace mote::test
