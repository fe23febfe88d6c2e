#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/report.h"
#include "core/error.h"
#include "core/text.h"

namespace mote {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* format_name = "mote bench 1";

/// JSON has no NaN: nlohmann writes null.
Json to_json(const RunError& e)
{
    return {{"mse", e.mse},
            {"trimmed_mse", e.trimmed_mse},
            {"relmse", e.rel_mse},
            {"trimmed_relmse", e.trimmed_rel_mse},
            {"worst_share", e.worst_share}};
}

Json to_json(const RunFigures& run)
{
    Json j = to_json(run.error);
    j["cpu_us"] = run.cpu_us;
    j["cache_us"] = run.cache_us;
    j["wall_us"] = run.wall_us;
    return j;
}

Json to_json(const MethodFigures& f)
{
    Json j{
        {"n_var", f.n_var}, {"bias", f.bias}, {"bias_error", f.bias_error}, {"bias_p", f.bias_p}};
    j.update(to_json(f.error));
    j.update(
        {{"cpu_us", f.cpu_us},
         {"cache_us", f.cache_us},
         {"wall_us", f.wall_us},
         {"pass_us", f.pass_us},
         {"bias_squared", f.bias_squared},
         {"rel_bias_squared", f.rel_bias_squared},
         {"us_to_1_percent", std::isinf(f.time_to_target) ? Json("never") : Json(f.time_to_target)},
         {"slope", f.slope},
         {"efficiency", f.efficiency},
         {"trimmed_efficiency", f.trimmed_efficiency},
         {"efficiency_error", f.efficiency_error},
         {"ratio", f.ratio},
         {"trimmed_ratio", f.trimmed_ratio}});
    return j;
}

Json to_json(const CurvePoint& p)
{
    return {{"samples", p.samples},
            {"cpu_us", p.cpu_us},
            {"cache_us", p.cache_us},
            {"mse", p.mse},
            {"relmse", p.rel_mse}};
}

/// Fields by name, as work_fields() and memory_fields() list them.
template <class Value, class Fields>
Json fields_json(const Value& value, const Fields& fields)
{
    Json j = Json::object();
    for (const auto& field : fields) j[field.name] = value.*field.value;
    return j;
}

Json to_json(const MethodResult& row)
{
    Json curve = Json::array();
    for (const CurvePoint& point : row.curve) curve.push_back(to_json(point));
    Json runs = Json::array();
    for (const RunFigures& run : row.runs) runs.push_back(to_json(run));
    return {{"name", row.name},
            {"is_reference", row.is_reference},
            {"is_biased", row.is_biased},
            {"samples", row.samples},
            {"compared_frames", row.compared},
            {"frames", row.frames},
            {"non_finite", row.non_finite},
            {"figures", to_json(row.figures)},
            {"curve", std::move(curve)},
            {"work", fields_json(row.work, work_fields())},
            {"memory_bytes", fields_json(row.memory, memory_fields())},
            {"runs", std::move(runs)}};
}

Json to_json(const ReferenceInfo& r)
{
    return {{"method", r.method},
            {"runs", r.runs},
            {"samples", r.samples},
            {"mean", r.mean},
            {"relative_error", r.relative_error},
            {"noise", r.noise}};
}

Json to_json(const SceneResult& scene)
{
    Json modes = Json::array();
    for (const ModeResult& mode : scene.modes) {
        Json rows = Json::array();
        for (const MethodResult& row : mode.rows) rows.push_back(to_json(row));
        modes.push_back({{"mode", mode_name(mode.mode)}, {"methods", std::move(rows)}});
    }
    return {{"scene", scene.path},
            {"name", scene.name},
            {"scene_hash", fmt::format("{:016x}", scene.hash)},
            {"width", scene.width},
            {"height", scene.height},
            {"frame", scene.frame},
            {"seed", scene.seed},
            {"reference", to_json(scene.reference)},
            {"left_out", scene.left_out},
            {"modes", std::move(modes)}};
}

double number_at(const Json& j, const char* key)
{
    const Json& value = j.at(key);
    return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

RunFigures run_from(const Json& j)
{
    RunFigures run;
    run.error = {number_at(j, "mse"), number_at(j, "trimmed_mse"), number_at(j, "relmse"),
                 number_at(j, "trimmed_relmse"), number_at(j, "worst_share")};
    run.cpu_us = number_at(j, "cpu_us");
    run.cache_us = number_at(j, "cache_us");
    run.wall_us = number_at(j, "wall_us");
    return run;
}

MethodResult method_from(const Json& j)
{
    MethodResult row;
    row.name = j.at("name").get<std::string>();
    row.is_reference = j.at("is_reference").get<bool>();
    row.samples = j.at("samples").get<int>();
    row.frames = j.at("frames").get<int>();
    row.non_finite = j.at("non_finite").get<int64_t>();
    for (const Json& run : j.at("runs")) row.runs.push_back(run_from(run));
    return row;
}

SceneResult scene_from(const Json& j)
{
    SceneResult scene;
    scene.path = j.at("scene").get<std::string>();
    scene.name = j.at("name").get<std::string>();
    scene.hash = std::stoull(j.at("scene_hash").get<std::string>(), nullptr, 16);
    scene.width = j.at("width").get<int>();
    scene.height = j.at("height").get<int>();
    scene.frame = j.at("frame").get<int>();
    scene.seed = j.at("seed").get<uint32_t>();
    for (const Json& entry : j.at("modes")) {
        const auto name = entry.at("mode").get<std::string>();
        ModeResult mode;
        for (const ModeInfo& info : mode_table()) {
            if (name == info.name) mode.mode = info.mode;
        }
        for (const Json& row : entry.at("methods")) mode.rows.push_back(method_from(row));
        scene.modes.push_back(std::move(mode));
    }
    return scene;
}

std::string csv_quote(const std::string& text)
{
    std::string quoted = "\"";
    for (const char c : printable(text, 1000)) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + '"';
}

}  // namespace

std::string bench_json(const BenchReport& report)
{
    Json scenes = Json::array();
    for (const SceneResult& scene : report.scenes) scenes.push_back(to_json(scene));
    const Json json{{"format", format_name},           {"version", report.version},
                    {"build", report.build},           {"threads", report.threads},
                    {"relmse_epsilon", "0.01 mean^2"}, {"trimmed_share", trimmed_share},
                    {"scenes", std::move(scenes)}};
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string bench_csv(const BenchReport& report)
{
    std::string text =
        "scene,mode,method,width,height,frame,samples,frames,runs,cpu_us,cache_us,wall_us,n_var,"
        "mse,trimmed_mse,relmse,trimmed_relmse,worst_share,bias,bias_error,efficiency,"
        "efficiency_error,ratio,trimmed_ratio,is_biased,compared_frames,pass_us,bias_squared,"
        "rel_bias_squared,us_to_1_percent,slope";
    for (const WorkField& field : work_fields()) text += fmt::format(",{}", field.name);
    for (const MemoryField& field : memory_fields()) text += fmt::format(",{}_bytes", field.name);
    text += "\n";
    for (const SceneResult& scene : report.scenes) {
        for (const ModeResult& mode : scene.modes) {
            for (const MethodResult& row : mode.rows) {
                const MethodFigures& f = row.figures;
                text += fmt::format("{},{},{},{},{},{},{},{},{}", csv_quote(scene.path),
                                    mode_name(mode.mode), row.name, scene.width, scene.height,
                                    scene.frame, row.samples, row.frames, row.runs.size());
                for (const double x :
                     {f.cpu_us, f.cache_us, f.wall_us, f.n_var, f.error.mse, f.error.trimmed_mse,
                      f.error.rel_mse, f.error.trimmed_rel_mse, f.error.worst_share, f.bias,
                      f.bias_error, f.efficiency, f.efficiency_error, f.ratio, f.trimmed_ratio}) {
                    text += fmt::format(",{:.7g}", x);
                }
                text += fmt::format(",{},{}", row.is_biased ? 1 : 0, row.compared);
                for (const double x :
                     {f.pass_us, f.bias_squared, f.rel_bias_squared, f.time_to_target, f.slope}) {
                    text += fmt::format(",{:.7g}", x);
                }
                for (const WorkField& field : work_fields()) {
                    text += fmt::format(",{:.7g}", row.work.*field.value);
                }
                for (const MemoryField& field : memory_fields()) {
                    text += fmt::format(",{:.0f}", row.memory.*field.value);
                }
                text += "\n";
            }
        }
    }
    return text;
}

BenchReport parse_bench_json(const std::string& text, const std::string& path)
{
    BenchReport report;
    try {
        const Json json = Json::parse(text);
        if (json.at("format").get<std::string>() != format_name) {
            throw Error(ExitCode::Input, fmt::format("{}: results of another version of mote bench",
                                                     printable(path, 1000)));
        }
        report.version = json.at("version").get<std::string>();
        report.build = json.at("build").get<std::string>();
        report.threads = json.at("threads").get<int>();
        for (const Json& scene : json.at("scenes")) report.scenes.push_back(scene_from(scene));
    } catch (const Json::exception& error) {
        throw Error(ExitCode::Input, fmt::format("{}: not a results file of mote bench --json: {}",
                                                 printable(path, 1000), printable(error.what())));
    } catch (const std::logic_error&) {  // a scene hash that is no number
        throw Error(ExitCode::Input, fmt::format("{}: not a results file of mote bench --json",
                                                 printable(path, 1000)));
    }
    return report;
}

}  // namespace mote
