#include "study/study.h"

#include <chrono>

#include <fmt/format.h>

#include "image/color_of.h"

namespace mote {

namespace {

double seconds_now()
{
    const auto time = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double>(time).count();
}

/// R, G and B alone.
LayeredImage colors_only(const LayeredImage& image)
{
    LayeredImage colors;
    colors.width = image.width;
    colors.height = image.height;
    for (const char* name : {"R", "G", "B"}) {
        if (const Channel* channel = image.find(name)) colors.channels.push_back(*channel);
    }
    return colors;
}

void add_tested(Study& study, const LayeredImage& image, int kept_runs)
{
    add_run(study.tested, image);
    add_run(study.tested_pixels, colors_only(image));
    study.kept.push_back(color_of(image));
    if (static_cast<int>(study.kept.size()) > kept_runs) study.kept.erase(study.kept.begin());
}

void add_reference(Study& study, const LayeredImage& image)
{
    add_run(study.reference, image);
    add_run(study.reference_pixels, colors_only(image));
    Buffer2D<Spectrum> color = color_of(image);
    replace_non_finite(color);
    add_run(study.reference_mean, color);
}

}  // namespace

Study run_study(const RunSource& tested, const RunSource& reference, const StudyParams& params,
                const std::function<void(const std::string&)>& say)
{
    Study study;
    study.tested = TileStats(params.tile_size);
    study.reference = TileStats(params.tile_size);
    const double start = seconds_now();
    for (int round = 0;; ++round) {
        const auto seed = params.seed + static_cast<uint32_t>(round);
        add_tested(study, tested(seed), params.kept_runs);
        add_reference(study, reference(reference_seed + seed));
        study.seconds = seconds_now() - start;
        const int next = static_cast<int>(study.looks.size()) + 1;
        const double next_round = study.seconds / (round + 1);
        const bool is_end = round + 1 >= params.most_runs ||
                            (params.seconds > 0.0 && study.seconds + next_round > params.seconds);
        if (round + 1 < runs_of_look(params.first_look, next) && !is_end) continue;
        study.looks.push_back(judge(study.tested, study.reference, params.question, next));
        const Look& look = study.last();
        if (say) say(fmt::format("{} runs each: {}", look.runs, look.reason));
        if (look.verdict != Verdict::NotEnoughRuns || is_end) return study;
    }
}

}  // namespace mote
