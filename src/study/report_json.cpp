#include <nlohmann/json.hpp>

#include <fmt/format.h>

#include "study/verify_report.h"

namespace mote {

namespace {

using Json = nlohmann::ordered_json;

Json to_json(const EstimatorInfo& info, int runs)
{
    return {{"method", info.name},
            {"samples", info.samples},
            {"frames", info.frames},
            {"runs", runs},
            {"run_seconds", info.run_seconds}};
}

Json to_json(const Look& look)
{
    return {{"runs", look.runs},
            {"alpha", look.alpha},
            {"p", look.comparison.p},
            {"p_tiles", look.comparison.p_tiles},
            {"p_whole_image", look.comparison.p_whole_image},
            {"detectable", look.detectable},
            {"tile_detectable", look.tile_detectable},
            {"verdict", verdict_name(look.verdict)},
            {"reason", look.reason}};
}

Json channels_json(const Look& look)
{
    Json channels = Json::array();
    for (const ChannelComparison& c : look.comparison.channels) {
        Json j{{"name", c.name},
               {"mean", c.tested.mean},
               {"mean_error", c.tested.standard_error()},
               {"reference_mean", c.reference.mean},
               {"reference_mean_error", c.reference.standard_error()},
               {"t", c.whole_image.t},
               {"p", c.whole_image.p},
               {"ratio_95", {c.mean_ratio.lower, c.mean_ratio.upper}},
               {"uniformity_p", c.uniformity.p},
               {"uniformity_tiles", c.uniformity.count},
               {"p_histogram", p_histogram(c)}};
        for (const ChannelBias& bias : look.channels) {
            if (bias.name != c.name) continue;
            j.update({{"scale", bias.scale},
                      {"bias", bias.bias},
                      {"bias_error", bias.standard_error},
                      {"detectable", bias.detectable},
                      {"equivalence_p", bias.equivalence_p},
                      {"excess_p", bias.excess_p}});
        }
        channels.push_back(std::move(j));
    }
    return channels;
}

Json to_json(const ErrorSplit& split)
{
    return {{"mse", split.mse()},
            {"bias_squared", split.bias_squared},
            {"noise_taken_off", split.noise},
            {"variance", split.variance}};
}

Json to_json(const ErrorFigures& e)
{
    return {{"absolute", to_json(e.absolute)},
            {"relative", to_json(e.relative)},
            {"epsilon", e.epsilon},
            {"single_runs", e.single_runs},
            {"relmse", e.rel_mse},
            {"trimmed_relmse", e.trimmed_rel_mse},
            {"worst_share", e.worst_share},
            {"autocovariance", e.autocovariance}};
}

Json to_json(const TemporalFigures& t)
{
    Json steps = Json::array();
    for (const StepResponse& step : t.steps) {
        steps.push_back({{"name", step.name},
                         {"mse", step.mse},
                         {"lag", step.lag < 0 ? Json(nullptr) : Json(step.lag)}});
    }
    return {{"runs", t.runs},
            {"frames", t.frames},
            {"autocorrelation", t.autocorrelation},
            {"boiling", t.boiling},
            {"steady_mse", t.steady_mse},
            {"steps", std::move(steps)}};
}

}  // namespace

std::string verify_json(const VerifyReport& report)
{
    const VerifyResult& r = report.result;
    const Look& look = r.study.last();
    const TileTests tests = tile_tests(r.study);
    Json worst = Json::array();
    for (const TileFinding& tile : tests.worst) {
        worst.push_back({{"channel", tile.channel},
                         {"column", tile.column},
                         {"row", tile.row},
                         {"mean", tile.tested},
                         {"reference_mean", tile.reference},
                         {"t", tile.t},
                         {"p", tile.p}});
    }
    Json looks = Json::array();
    for (const Look& each : r.study.looks) looks.push_back(to_json(each));
    Json json{
        {"format", "mote verify 1"},
        {"version", report.version},
        {"scene", r.path},
        {"name", r.name},
        {"scene_hash", fmt::format("{:016x}", r.hash)},
        {"verdict", verdict_name(look.verdict)},
        {"reason", look.reason},
        {"notes", report.notes},
        {"width", r.width},
        {"height", r.height},
        {"frame", r.frame},
        {"warm_up", r.warm_up},
        {"mode", mode_name(r.mode)},
        {"seed", r.params.seed},
        {"counters",
         {{"dropped_non_finite", 0},
          {"majorant_violations", 0},
          {"truncated_paths", r.truncated_paths}}},
        {"tested", to_json(r.tested, look.runs)},
        {"reference", to_json(r.reference, look.runs)},
        {"straight_light",
         {{"parts", r.straight.parts},
          {"tested_passes", r.straight.tested_passes},
          {"reference_passes", r.straight.reference_passes}}},
        {"question",
         {{"budget", r.params.question.budget},
          {"tile_budget", r.params.question.tile_budget},
          {"alpha", r.params.question.alpha},
          {"power", r.params.question.power},
          {"equivalence", r.params.question.equivalence}}},
        {"seconds", r.study.seconds},
        {"looks", std::move(looks)},
        {"channels", channels_json(look)},
        {"tiles",
         {{"columns", look.comparison.columns},
          {"rows", look.comparison.rows},
          {"size", r.params.tile_size},
          {"tests", tests.count},
          {"smallest_p", tests.smallest_p},
          {"rejected_by_holm", tests.rejected},
          {"worst", std::move(worst)}}},
        {"non_finite", look.comparison.non_finite},
        {"errors", r.errors.single_runs > 0 ? to_json(r.errors) : Json(nullptr)},
        {"temporal", r.temporal ? to_json(*r.temporal) : Json(nullptr)},
    };
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace mote
