// What a frame of the ReSTIR estimator costs and what it is worth: caches apart, rays, cells,
// noise.
//   bench_frame ROUNDS SCENE [KEY=VALUE ...] [-- KEY=VALUE ...] ...
// Each `--` begins one more row: the values before the first count for all of them. Frames of all
// rows take turns, one pass each, each with a seed of its own and new caches; process CPU time, the
// fastest of the rounds. The noise is half the mean square difference of two rounds, over the
// square of the image's mean, so it takes two rounds at least: "trimmed" without the 0.1 % of
// pixels that differ most. 1/(MSE t) with caches charged.

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include <fmt/format.h>

#include "core/parallel.h"
#include "render/frame.h"
#include "scene/prepare.h"
#include "scene/scene_io.h"

namespace mote {
namespace {

struct Row {
    std::string name;
    RenderDescription render;
    Scene scene;
    FrameStats best{};
    double wall = 1e30;
    std::vector<float> before;  ///< last round's image
    double noise = 0.0;
    double trimmed = 0.0;
    double mean = 0.0;
};

std::vector<float> colors_of(const LayeredImage& image)
{
    std::vector<float> out;
    const size_t pixels = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
    for (size_t i = 0; i < pixels; ++i) {
        for (size_t c = 0; c < 3; ++c) out.push_back(image.channels[c].data.data()[i]);
    }
    return out;
}

/// Half the mean square difference of two images, per pixel and channel.
void compare(const std::vector<float>& a, const std::vector<float>& b, Row& row)
{
    std::vector<double> squares;
    double sum = 0.0;
    for (size_t i = 0; i < a.size(); i += 3) {
        double square = 0.0;
        for (size_t c = i; c < i + 3; ++c) {
            const auto d = static_cast<double>(a[c] - b[c]);
            square += d * d / 6.0;
            sum += static_cast<double>(a[c] + b[c]) / 6.0;
        }
        squares.push_back(square);
    }
    const auto n = static_cast<double>(squares.size());
    const auto keep = squares.size() - squares.size() / 1000;
    std::nth_element(squares.begin(), squares.begin() + static_cast<ptrdiff_t>(keep) - 1,
                     squares.end());
    double trimmed = 0.0;
    double whole = 0.0;
    for (size_t i = 0; i < squares.size(); ++i) (i < keep ? trimmed : whole) += squares[i];
    whole += trimmed;
    row.mean = sum / n;
    row.noise += whole / n;
    row.trimmed += trimmed / static_cast<double>(keep);
}

void render(Row& row, int round)
{
    row.render.seed = static_cast<uint32_t>(round) + 1;
    OutputDescription output;
    output.color_type = PixelType::Float;
    FrameHistory history;
    history.expect_no_more();
    FrameStats stats;
    const LayeredImage image = render_frame(row.scene, row.render, output, history, nullptr, stats);
    if (round == 0 || stats.render_cpu_seconds < row.best.render_cpu_seconds) row.best = stats;
    row.wall = std::min(row.wall, stats.render_seconds);
    std::vector<float> colors = colors_of(image);
    if (round > 0) compare(row.before, colors, row);
    row.before = std::move(colors);
}

void report(const std::vector<Row>& rows, int rounds)
{
    fmt::print(
        "{:44} {:>6} {:>7} {:>7} {:>7} {:>6} {:>7} {:>7} {:>6} {:>6} {:>7} {:>9} {:>9} {:>9} "
        "{:>9}\n",
        "", "wall s", "CPU s", "caches", "us/px", "rays", "cells", "cam.c.", "coarse", "cells",
        "ns/cell", "noise", "trimmed", "1/(MSE t)", "trimmed");
    for (const Row& row : rows) {
        const FrameStats& s = row.best;
        const auto pixels = static_cast<double>(s.paths);
        const double drawn = s.render_cpu_seconds - s.cache_cpu_seconds;
        const double us = s.render_cpu_seconds / pixels * 1e6;
        const double pairs = std::max(rounds - 1, 1) * row.mean * row.mean;
        const double noise = row.noise / pairs;
        const double trimmed = row.trimmed / pairs;
        const auto light_rays = static_cast<double>(s.light_rays);
        fmt::print(
            "{:44} {:6.2f} {:7.2f} {:7.2f} {:7.2f} {:6.2f} {:7.1f} {:7.1f} {:6.2f} {:6.1f} {:7.2f} "
            "{:9.3g} {:9.3g} "
            "{:9.4g} {:9.4g}\n",
            row.name, row.wall, s.render_cpu_seconds, s.cache_cpu_seconds, us, light_rays / pixels,
            static_cast<double>(s.light_ray_cells) / std::max(light_rays, 1.0),
            static_cast<double>(s.cells - s.light_ray_cells) / pixels,
            static_cast<double>(s.coarse_rays) / pixels,
            static_cast<double>(s.coarse_ray_cells) /
                std::max(1.0, static_cast<double>(s.coarse_rays)),
            drawn / static_cast<double>(s.cells + s.coarse_ray_cells) * 1e9, noise, trimmed,
            1.0 / (noise * us), 1.0 / (trimmed * us));
    }
}

int run(int argc, char** argv)
{
    if (argc < 3) {
        fmt::print(stderr, "bench_frame ROUNDS SCENE [KEY=VALUE ...] [-- KEY=VALUE ...] ...\n");
        return 2;
    }
    const int rounds = std::max(std::atoi(argv[1]), 1);
    const std::string scene = argv[2];
    std::vector<std::vector<std::string>> sets(1);
    for (int i = 3; i < argc; ++i) {
        if (std::strcmp(argv[i], "--") == 0) {
            sets.emplace_back(sets.front());
        } else {
            sets.back().emplace_back(argv[i]);
        }
    }
    const size_t shared = sets.front().size();
    if (sets.size() > 1) sets.erase(sets.begin());
    SceneCache cache;
    std::vector<Row> rows;
    for (const std::vector<std::string>& values : sets) {
        std::vector<std::string> all{"render.estimator=restir", "render.samples=1"};
        all.insert(all.end(), values.begin(), values.end());
        const SceneDescription description = load_scene(scene, all);
        Row row;
        for (size_t i = shared; i < values.size(); ++i) {
            const std::string key = values[i].substr(0, values[i].find('='));
            if (!row.name.empty()) row.name += ' ';
            row.name += values[i].substr(key.rfind('.') + 1);
        }
        row.render = description.render;
        PrepareStats stats;
        row.scene = prepare_frame(description, description.first_frame, {}, cache, stats);
        rows.push_back(std::move(row));
    }
    for (int round = 0; round < rounds; ++round) {
        for (Row& row : rows) render(row, round);
    }
    report(rows, rounds);
    return 0;
}

}  // namespace
}  // namespace mote

int main(int argc, char** argv)
{
    return mote::run(argc, argv);
}
