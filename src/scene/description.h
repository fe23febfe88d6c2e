#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/transform.h"
#include "image/exr.h"
#include "image/png.h"
#include "particles/source.h"
#include "scene/march_params.h"
#include "scene/path_tracer_params.h"
#include "scene/restir_params.h"
#include "surfaces/material.h"
#include "volumes/grid_source.h"
#include "volumes/phase.h"
#include "volumes/volume.h"

namespace mote {

/// A scene file as plain data: what to evaluate at each frame. Units and ranges of every field
/// are in scenes/README.md and are checked when the file is read.

struct CameraKey {
    double frame = 0.0;
    std::optional<Vec3d> position, look_at, up;
    std::optional<double> fov, focus_distance, lens_radius;
};

/// A camera of a glTF file.
struct CameraFile {
    std::string path;  ///< relative to the scene file; empty: none
    std::string name;  ///< of the camera or of its node; empty: the first
};

struct CameraDescription {
    CameraFile file;                ///< in place of position, look_at, up, fov and keys
    Vec3d position{0.0, 0.0, 5.0};  ///< [m]
    Vec3d look_at{0.0};             ///< [m]
    Vec3d up{0.0, 1.0, 0.0};
    double fov = 45.0;            ///< vertical field of view [degrees], (0, 180)
    double lens_radius = 0.0;     ///< [m]; 0: everything is sharp
    double focus_distance = 0.0;  ///< [m]; 0: distance to look_at
    double shutter_open = 0.0;    ///< [frames], relative to the frame
    double shutter_close = 0.0;   ///< [frames]; equal to open: no motion blur
    std::vector<CameraKey> keys;  ///< override the fields above, linear between
};

enum class EstimatorKind {
    Path,    ///< the reference path tracer
    Restir,  ///< volumetric ReSTIR; events beyond the first by the path tracer
    March,   ///< the biased ray marcher of `mote bench`: scene files cannot name it
};

struct RenderDescription {
    int width = 640;
    int height = 360;
    int samples = 16;  ///< per pixel
    uint32_t seed = 0;
    EstimatorKind estimator = EstimatorKind::Restir;
    PathTracerParams path;  ///< bounces, roulette, transmittance, light choice
    RestirParams restir;
    MarchParams march;
};

struct OutputDescription {
    std::string path = "out/####.exr";  ///< EXR pattern, relative to the working folder
    std::string preview;                ///< PNG pattern; empty: none
    std::vector<std::string> aovs;      ///< layers beside RGBA
    PixelType color_type = PixelType::Half;
    ExrCompression compression = ExrCompression::Zip;
    PreviewParams view;
};

/// A volume takes its density from exactly one of: a grid file, a particle system, a procedural.
struct VolumeDescription {
    std::string name;
    std::optional<SequenceParams> file;  ///< .vdb fog volumes
    std::string particles;               ///< name of a [[particles]] entry
    std::optional<ProceduralParams> procedural;
    std::string density_grid = "density";
    std::string temperature_grid = "temperature";  ///< read only if something emits
    std::string emission_grid = "emission";        ///< read only if emission_scale > 0
    std::string color_grid = "Cd";                 ///< read only if use_color
    std::string velocity_grid = "velocity";        ///< read only if something needs motion
    float density_scale = 1.0f;                    ///< sigma_t per density unit [1/m]
    Spectrum albedo{0.9f};
    bool use_color = false;  ///< multiply albedo by the colour grid
    Phase phase;
    Emission emission;
    std::vector<TransformKey> transform;  ///< world from object
};

struct ParticlesDescription {
    std::string name;
    SourceParams source;
    float voxel_size = 0.02f;  ///< of the rasterised grids [m]
};

enum class LightKind { Point, Spot, Distant, Sphere, Quad, Environment };

/// A light, or a swarm of them. Positions are in the light's object space; `transform` moves it.
/// How bright a light is at a frame.
struct LightKey {
    double frame = 0.0;
    std::optional<double> strength;
    std::optional<Vec3d> color;
};

struct LightDescription {
    std::string name;
    LightKind kind = LightKind::Point;
    Vec3 position{0.0f};               ///< point, sphere: centre; quad: corner [m]
    Vec3 direction{0.0f, 1.0f, 0.0f};  ///< distant: towards the light; spot: from it
    Vec3 edge_u{1.0f, 0.0f, 0.0f}, edge_v{0.0f, 0.0f, 1.0f};  ///< quad [m]
    float cone_angle = 45.0f;                                 ///< spot: from side to side [degrees]
    float blend = 0.2f;            ///< spot: share of the cone that fades, [0,1]
    float radius = 0.1f;           ///< sphere [m]
    Spectrum color{1.0f};          ///< multiplies strength
    float strength = 1.0f;         ///< point: [W/sr]; distant: [W/m^2]; others: [W/(m^2 sr)]
    bool two_sided = false;        ///< quad
    std::string image;             ///< environment: .exr, .hdr, .png or .jpg file
    int count = 1;                 ///< point, sphere: this many copies scattered over `spread`
    Vec3 spread{0.0f};             ///< edges of the box around `position` for the copies [m]
    uint32_t seed = 1;             ///< of the scattering
    std::string particles;         ///< sphere: one for each particle of this system; empty: not
    float radius_scale = 1.0f;     ///< of these, over the particles' radii
    bool use_color = false;        ///< their radiance is multiplied by the particles' colours,
    bool use_temperature = false;  ///< by (T/1500 K)^4 blackbody_rgb(T)
    std::vector<LightKey> keys;    ///< of strength and colour
    std::vector<TransformKey> transform;
};

/// Image files of a material's pictures, relative to the scene file; empty: none.
struct MaterialFiles {
    std::string color, roughness, metallic, normal, emission;
    float normal_strength = 1.0f;
    float alpha_cutoff = 0.0f;  ///< [0,1]
};

/// All of the files that may be given.
[[nodiscard]] inline std::array<const std::string*, 5> picture_files(const MaterialFiles& files)
{
    return {&files.color, &files.roughness, &files.metallic, &files.normal, &files.emission};
}

/// What objects are made of.
struct MaterialDescription {
    /// Of a [[materials]] entry: its own. Of an object's material: of the entry that it is, which
    /// leaves the rest without meaning; empty: described here.
    std::string name;
    Material look;                  ///< its emission is that of the next two fields
    float emission = 0.0f;          ///< [W/(m^2 sr)]
    Spectrum emission_color{1.0f};  ///< multiplies it
    MaterialFiles files;
};

/// A thing made of triangles.
struct ObjectDescription {
    std::string name;
    SequenceParams file;        ///< a mesh, .obj or .ply, or a .gltf or .glb file
    bool has_material = false;  ///< else: that of a glTF file, the default one of others
    MaterialDescription material;
    std::vector<TransformKey> transform;  ///< world from object
};

struct SceneDescription {
    std::string path;      ///< of the scene file, for messages
    std::string base_dir;  ///< resolves relative input paths
    std::string name;
    double fps = 24.0;    ///< frames per second
    int first_frame = 1;  ///< default range of `mote render`
    int last_frame = 1;
    CameraDescription camera;
    RenderDescription render;
    OutputDescription output;
    std::vector<VolumeDescription> volumes;
    std::vector<ParticlesDescription> particles;
    std::vector<LightDescription> lights;
    std::vector<MaterialDescription> materials;
    std::vector<ObjectDescription> objects;
    uint64_t hash = 0;  ///< of the resolved description, order of keys irrelevant
};

}  // namespace mote
