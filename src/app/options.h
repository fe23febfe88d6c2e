#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "study/question.h"

namespace mote {

/// What every command understands.
struct LogOptions {
    bool quiet = false;  ///< errors only, no progress
    int verbosity = 0;   ///< 0: warnings; 1: what is done; 2: details
    std::string file;    ///< also log there; empty: nowhere
    bool json = false;   ///< one JSON object per line on stderr
};

/// What to do with a frame whose file exists.
enum class ExistingMode {
    Overwrite,
    Skip,    ///< keep it if it opens and is complete
    Verify,  ///< keep it if also its size, scene hash and layers are those of this render
};

enum class ProgressMode { Auto, Json, None };

struct RenderOptions {
    std::string scene;
    std::vector<std::string> overrides;  ///< "a.b=value", applied after the scene is read
    std::string frames;                  ///< empty: the scene's range
    std::string output;                  ///< empty: the scene's
    std::string preview;                 ///< empty: the scene's
    std::optional<std::string> aovs;
    ExistingMode existing = ExistingMode::Overwrite;
    ProgressMode progress = ProgressMode::Auto;
    std::string stats;
    int warmup = 0;             ///< frames rendered for history before the first one
    int threads = 0;            ///< 0: those this process may use
    double memory_limit = 0.0;  ///< [bytes]; 0: none
    bool dry_run = false;
    bool reproducible = false;  ///< no times in the files
    LogOptions log;
};

struct CheckOptions {
    std::string scene;
    std::vector<std::string> overrides;
    std::string frames;  ///< empty: first and last frame of the scene
    LogOptions log;
};

struct InfoOptions {
    std::string file;
    std::vector<std::string> overrides;
    std::optional<int> frame;  ///< for patterns and scenes
    double fps = 24.0;         ///< for displacements of plain files
    LogOptions log;
};

struct CacheOptions {
    std::string input;  ///< scene, or particle file pattern
    std::vector<std::string> overrides;
    std::string particles;  ///< name of the scene's particle system
    std::string frames;
    std::string points;                   ///< pattern of VDB points; empty: none
    std::string grids;                    ///< pattern of VDB density grids; empty: none
    std::string channels;                 ///< grids beside density: "velocity,temperature,color"
    std::optional<float> voxel_size;      ///< [m]; empty: the scene's
    double fps = 24.0;                    ///< plain files
    bool velocity_per_frame = false;      ///< plain files
    std::vector<std::string> attributes;  ///< plain files: "radius=pscale"
    ExistingMode existing = ExistingMode::Overwrite;
    ProgressMode progress = ProgressMode::Auto;
    int threads = 0;
    LogOptions log;
};

struct SheetOptions {
    std::string output;
    std::vector<std::string> inputs;
    int columns = 0;  ///< 0: near a square
    LogOptions log;
};

struct CompareOptions {
    std::string tested;                   ///< A
    std::string reference;                ///< B
    std::vector<std::string> thresholds;  ///< "relmse=0.01"
    std::string layers;                   ///< by comma; empty: all that describe the picture
    std::string json;                     ///< file; empty: none
    std::string difference;               ///< .exr or .png; empty: none
    LogOptions log;
};

struct BenchOptions {
    std::vector<std::string> inputs;      ///< scenes; with `against`, one results file
    std::vector<std::string> overrides;   ///< as for render
    std::vector<std::string> resolution;  ///< overrides that --resolution stands for
    std::string modes;                    ///< by comma; empty: by what moves in the scene
    std::string methods;                  ///< by comma; empty: those worthwhile for the scene
    std::string reference;                ///< method; empty: the best path tracer
    std::optional<int> frame;
    std::optional<std::string> frames;  ///< "WARM-UP+STILL"
    std::optional<int> runs;
    int samples = 0;              ///< 0: equal times
    int passes = 1;               ///< of restir per frame
    double time_budget = 0.0;     ///< [s] per scene; 0: none
    double reference_time = 0.0;  ///< [s]; 0: that of all runs
    int seed = 1;
    int threads = 1;
    bool quick = false;
    bool list = false;          ///< print the methods and be done
    std::string json;           ///< file; empty: none
    std::string csv;            ///< file; empty: none
    std::string html;           ///< file; empty: none
    std::string svg;            ///< folder of plots; empty: none
    std::string sweep;          ///< by comma; empty: methods on scenes are measured
    double max_seconds = 60.0;  ///< of a sweep
    std::string against;        ///< results file; empty: measure
    LogOptions log;
};

struct VerifyOptions {
    std::string scene;
    std::vector<std::string> overrides;   ///< as for render
    std::vector<std::string> resolution;  ///< overrides that --resolution stands for
    bool full_size = false;               ///< keep the scene's size
    std::string method;                   ///< empty: restir with the scene's settings
    std::string reference;                ///< empty: the path tracer that suits the lights
    int passes = 0;                       ///< 0: see VerifyParams
    std::optional<int> frame;
    std::optional<int> warm_up;
    Question question;
    int tile_size = 8;
    int runs = 4096;
    double time = 420.0;  ///< [s]
    bool sequences = true;
    int seed = 1;
    int threads = 0;   ///< 0: those this process may use
    std::string json;  ///< file; empty: none
    std::string html;  ///< file; empty: none
    LogOptions log;
};

struct SchemaOptions {
    bool markdown = false;
};

struct VersionOptions {};

/// Text to print and be done: help.
struct PrintText {
    std::string text;
};

using CommandLine =
    std::variant<PrintText, RenderOptions, CheckOptions, InfoOptions, CacheOptions, SheetOptions,
                 CompareOptions, BenchOptions, VerifyOptions, SchemaOptions, VersionOptions>;

}  // namespace mote
