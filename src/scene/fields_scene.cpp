#include "scene/aov_names.h"
#include "scene/fields.h"

namespace mote {
namespace {

constexpr std::array estimator_names = {"path", "restir"};
constexpr std::array transmittance_names = {"ratio", "residual_ratio", "exact"};
constexpr std::array light_sampler_names = {"auto", "power", "power_distance", "tree"};
constexpr std::array light_strategy_names = {"auto", "mis", "next_event", "phase"};
constexpr std::array mis_names = {"power", "balance"};
constexpr std::array pixel_type_names = {"half", "float"};
constexpr std::array compression_names = {"none", "zip", "zips", "piz"};
constexpr std::array view_names = {"srgb", "filmic"};

}  // namespace

void describe(FieldVisitor& v, SceneDescription& scene)
{
    visit(v, {.key = "name", .doc = "Title, written into the images", .changes_picture = false},
          scene.name);
    visit(v,
          {.key = "fps",
           .doc = "Frames per second; turns frames into time",
           .unit = "1/s",
           .range = between(0.001, 100'000),
           .also = "rate frame_rate framerate"},
          scene.fps);
    visit(v,
          {.key = "first_frame",
           .doc = "First frame that `mote render` makes by default",
           .range = frame_range,
           .changes_picture = false,
           .also = "start frames frame"},
          scene.first_frame);
    visit(v,
          {.key = "last_frame",
           .doc = "Last frame that `mote render` makes by default",
           .range = frame_range,
           .changes_picture = false,
           .also = "end"},
          scene.last_frame);
    visit_table(v, {.key = "camera", .doc = "Where from, and through which lens"}, scene.camera);
    visit_table(v, {.key = "render", .doc = "Image size, samples, estimator"}, scene.render);
    visit_table(v, {.key = "output", .doc = "Files and layers"}, scene.output);
    visit_list(v, {.key = "volumes", .doc = "Media, which may overlap", .also = "volume media"},
               scene.volumes);
    visit_list(v,
               {.key = "particles",
                .doc = "Particle systems, shown by the volumes that name them",
                .also = "particle"},
               scene.particles);
    visit_list(v, {.key = "lights", .doc = "Light sources", .also = "light lamps"}, scene.lights);
    visit_list(v,
               {.key = "materials",
                .doc = "What objects are made of, for those that name them",
                .also = "material"},
               scene.materials);
    visit_list(v,
               {.key = "objects",
                .doc = "Things with surfaces: meshes and glTF files",
                .also = "object mesh meshes"},
               scene.objects);
}

void describe(FieldVisitor& v, CameraFile& file)
{
    visit(v, {.key = "path", .doc = "glTF file (.gltf, .glb), relative to the scene file"},
          file.path);
    visit(v, {.key = "name", .doc = "Of the camera or of its node; default: the first one"},
          file.name);
}

void describe(FieldVisitor& v, CameraDescription& camera)
{
    visit_table(v,
                {.key = "file",
                 .doc = "A camera of a glTF file, with its motion, in place of `position`, "
                        "`look_at`, `up`, `fov` and `keys`; text alone is the `path`",
                 .also = "from gltf glb",
                 .shorthand = "path"},
                camera.file);
    visit(v,
          {.key = "position",
           .doc = "Place of the lens",
           .unit = "m",
           .range = length_range,
           .also = "origin eye translate"},
          camera.position);
    visit(v,
          {.key = "look_at",
           .doc = "Point in the middle of the picture",
           .unit = "m",
           .range = length_range,
           .also = "target"},
          camera.look_at);
    visit(v,
          {.key = "up", .doc = "Direction that is upwards in the picture", .range = length_range},
          camera.up);
    visit(v,
          {.key = "fov",
           .doc = "Vertical field of view",
           .unit = "degrees",
           .range = between(0.01, 179),
           .also = "angle focal"},
          camera.fov);
    visit(v,
          {.key = "lens_radius",
           .doc = "Radius of the lens opening; 0: everything is sharp",
           .unit = "m",
           .range = between(0, 1e6),
           .also = "aperture fstop"},
          camera.lens_radius);
    visit(v,
          {.key = "focus_distance",
           .doc = "Distance along the view axis that is sharp; 0: that of look_at",
           .unit = "m",
           .range = between(0, 1e9),
           .also = "focal_distance"},
          camera.focus_distance);
    visit(v,
          {.key = "shutter_open",
           .doc = "Opening of the shutter, relative to the frame",
           .unit = "frames",
           .range = between(-100, 100),
           .also = "shutter"},
          camera.shutter_open);
    visit(v,
          {.key = "shutter_close",
           .doc = "Closing of the shutter; equal to shutter_open: no motion blur",
           .unit = "frames",
           .range = between(-100, 100)},
          camera.shutter_close);
    visit_list(v,
               {.key = "keys",
                .doc = "Keyframes, ascending; each value runs linearly between the keys that "
                       "give it and replaces the one above",
                .also = "keyframes animation"},
               camera.keys);
}

void describe(FieldVisitor& v, CameraKey& key)
{
    visit(v,
          {.key = "frame", .doc = "When", .unit = "frames", .range = frame_range, .required = true},
          key.frame);
    visit_optional(v,
                   {.key = "position", .doc = "As in [camera]", .unit = "m", .range = length_range},
                   key.position);
    visit_optional(v,
                   {.key = "look_at", .doc = "As in [camera]", .unit = "m", .range = length_range},
                   key.look_at);
    visit_optional(v, {.key = "up", .doc = "As in [camera]", .range = length_range}, key.up);
    visit_optional(
        v, {.key = "fov", .doc = "As in [camera]", .unit = "degrees", .range = between(0.01, 179)},
        key.fov);
    visit_optional(
        v,
        {.key = "focus_distance", .doc = "As in [camera]", .unit = "m", .range = between(0, 1e9)},
        key.focus_distance);
    visit_optional(
        v, {.key = "lens_radius", .doc = "As in [camera]", .unit = "m", .range = between(0, 1e6)},
        key.lens_radius);
}

void describe(FieldVisitor& v, RenderDescription& render)
{
    visit(v,
          {.key = "width",
           .doc = "Width of the image",
           .unit = "pixels",
           .range = between(1, 65536),
           .also = "resolution size"},
          render.width);
    visit(v,
          {.key = "height",
           .doc = "Height of the image",
           .unit = "pixels",
           .range = between(1, 65536)},
          render.height);
    visit(v,
          {.key = "samples",
           .doc = "Paths per pixel; noise falls with the square root",
           .range = between(1, 10'000'000),
           .also = "spp"},
          render.samples);
    visit(v,
          {.key = "bounces",
           .doc = "Scattering events of a path: 1 is single scattering, 0 emission only",
           .range = between(0, 1'000'000),
           .also = "max_bounces depth max_depth"},
          render.path.max_bounces);
    visit(v, {.key = "seed", .doc = "Chooses the random numbers"}, render.seed);
    visit_choice(v, {.key = "estimator", .doc = "How light is computed", .also = "integrator"},
                 render.estimator, estimator_names);
    visit_table(v,
                {.key = "path",
                 .doc = "How the path estimator samples; every choice is "
                        "unbiased and only moves noise and time"},
                render.path);
    visit_table(v,
                {.key = "restir",
                 .doc = "How the restir estimator samples; unbiased unless a key says otherwise"},
                render.restir);
}

void describe(FieldVisitor& v, PathTracerParams& path)
{
    visit(v,
          {.key = "roulette_start",
           .doc = "Scattering events before Russian roulette may end a path",
           .range = between(0, 1'000'000),
           .also = "roulette"},
          path.roulette_start);
    visit_choice(v, {.key = "transmittance", .doc = "Estimate of the light that reaches a point"},
                 path.transmittance, transmittance_names);
    visit_choice(v,
                 {.key = "light_sampler",
                  .doc = "How one of many lights is chosen: by power, by power over squared "
                         "distance, or by a tree; auto picks by their number"},
                 path.light_sampler, light_sampler_names);
    visit_choice(v,
                 {.key = "light_strategy",
                  .doc = "Rays that find the lights: shadow rays (next_event), scattered rays "
                         "(phase), or both weighted (mis); auto is mis where it pays"},
                 path.light_strategy, light_strategy_names);
    visit_choice(v, {.key = "mis", .doc = "Weights between the two kinds of rays"}, path.mis,
                 mis_names);
    visit(v,
          {.key = "equiangular",
           .doc = "Sample the first distance towards near lights as well; for lights inside "
                  "thin media"},
          path.equiangular);
}

void describe(FieldVisitor& v, OutputDescription& output)
{
    visit(v,
          {.key = "path",
           .doc = "OpenEXR files, relative to the working folder; `####` is the frame number",
           .changes_picture = false,
           .also = "file exr"},
          output.path);
    visit(v,
          {.key = "preview",
           .doc = "PNG previews; empty: none",
           .changes_picture = false,
           .also = "png"},
          output.preview);
    v.words({.key = "aovs", .doc = "Layers beside RGBA, see the list below", .also = "layers"},
            output.aovs, aov_names);
    visit_choice(v,
                 {.key = "color_type",
                  .doc = "Precision of the colour layers; data layers are "
                         "always float",
                  .also = "pixel_type"},
                 output.color_type, pixel_type_names);
    visit_choice(v,
                 {.key = "compression",
                  .doc = "Lossless compression of the OpenEXR files",
                  .changes_picture = false},
                 output.compression, compression_names);
    visit(v,
          {.key = "exposure",
           .doc = "Brightness of the previews: light is multiplied by 2^this",
           .unit = "stops",
           .range = between(-50, 50),
           .changes_picture = false},
          output.view.exposure);
    visit_choice(v, {.key = "view", .doc = "Tone curve of the previews", .changes_picture = false},
                 output.view.view, view_names);
}

}  // namespace mote
