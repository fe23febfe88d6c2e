#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "plots/page.h"
#include "plots/svg.h"
#include "study/pictures.h"
#include "study/verify_report.h"

namespace mote {

namespace {

/// t at which the maps reach full colour.
constexpr double full_t = 5.0;

const char* verdict_color(Verdict verdict)
{
    switch (verdict) {
        case Verdict::NoBias:
            return "#2a7a3a";
        case Verdict::BiasFound:
            return "#b02a2a";
        case Verdict::NotEnoughRuns:
            return "#8a6d1a";
    }
    return "";
}

std::string figure(const Buffer2D<Spectrum>& picture, const PreviewParams& view,
                   const std::string& caption)
{
    return fmt::format(
        "<figure><img alt=\"{0}\" src=\"{1}\"><figcaption>{0}</figcaption></figure>\n",
        html_text(caption), data_uri(picture, view));
}

std::string pictures(const VerifyReport& report)
{
    const Study& study = report.result.study;
    const PreviewParams display{0.0f, ViewTransform::Srgb};
    std::string html = "<h2>Pictures</h2>\n";
    html += figure(mean_picture(study.tested_pixels), report.view, "Tested: mean of all runs");
    html +=
        figure(mean_picture(study.reference_pixels), report.view, "Reference: mean of all runs");
    html += figure(tile_t_picture(study.last().comparison, full_t), display,
                   "Signed t of tested - reference, tiles; red brighter, blue darker, full colour "
                   "at 5; the largest of R, G, B");
    html += figure(pixel_t_picture(study.tested_pixels, study.reference_pixels, full_t), display,
                   "The same, pixels: not tested one by one, as single pixels are far from normal");
    html += figure(noise_picture(study.tested_pixels), display,
                   "Tested: standard deviation of a run, white at its 99th percentile");
    html += figure(noise_picture(study.reference_pixels), display,
                   "Reference: standard deviation of a run, its own scale");
    return html;
}

/// Counts of the channel's p-values; even, if nothing is biased.
std::string p_value_plot(const ChannelComparison& channel)
{
    std::vector<double> counts;
    double total = 0.0;
    double most = 1.0;
    for (const int64_t count : p_histogram(channel)) {
        counts.push_back(static_cast<double>(count));
        total += counts.back();
        most = std::max(most, counts.back());
    }
    if (total == 0.0) return "";
    const Plot plot{fmt::format("{}: {} tiles, uniform with p = {:.2g}", channel.name, total,
                                channel.uniformity.p),
                    {"p = 0", "1"},
                    0.0,
                    1.1 * most};
    return bar_plot(plot, counts, total / static_cast<double>(counts.size()));
}

std::string p_value_plots(const Look& look)
{
    std::string html =
        "<h2>p-values of the tiles</h2>\n<p>Without bias they are uniform (dashed). A crowd at 0 "
        "is "
        "bias; the uniformity test assumes that tiles are independent, which those of spatial "
        "reuse are not.</p>\n";
    for (const ChannelComparison& channel : look.comparison.channels) {
        html += p_value_plot(channel);
    }
    return html;
}

std::string error_plots(const VerifyResult& result)
{
    std::string html;
    const std::vector<double>& all = result.errors.autocovariance;
    if (all.size() > 1) {
        const std::vector<double> lags(all.begin() + 1, all.end());
        const auto [low, high] = std::minmax_element(lags.begin(), lags.end());
        const Plot plot{"Correlation of the error between pixels",
                        {"1 px apart", fmt::format("{} px", lags.size())},
                        std::min(1.1 * *low, -0.02),
                        std::max(1.1 * *high, 0.05)};
        html += bar_plot(plot, lags, 0.0);
    }
    if (result.temporal && !result.temporal->steps.empty()) {
        std::vector<std::string> names;
        std::vector<std::vector<double>> rows;
        double most = 3.0;
        for (const StepResponse& step : result.temporal->steps) {
            names.push_back(step.name);
            rows.push_back(step.mse);
            for (const double mse : step.mse) most = std::max(most, 1.1 * mse);
        }
        const Plot plot{"MSE after a step, over the steady one (dashed: twice)",
                        {"frame 0", fmt::format("{}", rows.front().size() - 1)},
                        0.0,
                        most};
        html += line_plot(plot, names, rows, 2.0);
    }
    return html.empty() ? html : "<h2>Errors in space and time</h2>\n" + html;
}

std::string look_table(const Study& study)
{
    std::string text = fmt::format("{:>6} {:>10} {:>10} {:>10} {:>10} {:>10}\n", "runs", "alpha",
                                   "p", "finds", "in a tile", "verdict");
    for (const Look& look : study.looks) {
        text += fmt::format("{:>6} {:>10.2g} {:>10.2g} {:>8.2g} % {:>8.2g} % {:>10}\n", look.runs,
                            look.alpha, look.comparison.p, 100.0 * look.detectable,
                            100.0 * look.tile_detectable, verdict_name(look.verdict));
    }
    return "<h2>Looks</h2>\n" + preformatted(text);
}

}  // namespace

std::string verify_html(const VerifyReport& report)
{
    const VerifyResult& r = report.result;
    std::string html = page_begin("mote verify");
    html += fmt::format("<h1>mote verify: {}</h1>\n", html_text(r.name.empty() ? r.path : r.name));
    html += fmt::format("<p class=\"verdict\" style=\"background:{}\"><b>{}</b>: {}</p>\n",
                        verdict_color(r.study.verdict()), verdict_name(r.study.verdict()),
                        html_text(r.study.last().reason));
    html += preformatted(verify_text(report));
    html += pictures(report);
    html += p_value_plots(r.study.last());
    html += error_plots(r);
    html += look_table(r.study);
    html += fmt::format("<p>mote {}, scene hash {:016x}, seed {}.</p>\n", html_text(report.version),
                        r.hash, r.params.seed);
    return html + page_end();
}

}  // namespace mote
