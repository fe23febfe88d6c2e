#include "render/aov.h"

#include <fmt/core.h>

#include "core/error.h"
#include "core/text.h"

namespace mote {
namespace {

std::vector<std::string> rgb(const std::string& layer)
{
    return {layer + ".R", layer + ".G", layer + ".B"};
}

std::vector<AovInfo> make_table()
{
    return {
        {Aov::Z,
         "Z",
         {"Z"},
         true,
         "Nearest first collision or surface over the pixel's samples, along the view axis [m]; "
         "1e10: "
         "none. "
         "Fog has no single depth: this is where it begins"},
        {Aov::VolumeZ,
         "volume_Z",
         {"volume_Z.Z"},
         true,
         "Mean depth of first collisions with smoke along the view axis, so weighted by "
         "transmittance times "
         "extinction [m]; 1e10: none"},
        {Aov::Albedo, "albedo", rgb("albedo"), false,
         "Single-scattering albedo at first collisions, base colour on surfaces, premultiplied by "
         "alpha"},
        {Aov::Motion,
         "motion",
         {"motion.u", "motion.v"},
         true,
         "Where what is seen moves until the next frame, mean over first collisions (else of the "
         "background) [pixels]; u to the right, v up"},
        {Aov::Variance, "variance", rgb("variance"), true,
         "Variance of the pixel's mean (not of one sample), per channel of RGB"},
        {Aov::Samples, "samples", {"samples.Y"}, true, "Camera paths per pixel"},
        {Aov::VolumeDirect, "volume_direct", rgb("volume_direct"), false,
         "Radiance scattered once, in smoke"},
        {Aov::VolumeIndirect, "volume_indirect", rgb("volume_indirect"), false,
         "Radiance scattered twice or more, last in the smoke that is seen"},
        {Aov::VolumeEmission, "volume_emission", rgb("volume_emission"), false,
         "Radiance emitted by volumes straight towards the camera"},
        {Aov::Background, "background", rgb("background"), false,
         "Radiance of environment and area lights seen through the volumes; with the volume "
         "and surface parts it sums to RGB"},
        {Aov::Transmittance, "transmittance", rgb("transmittance"), true,
         "Share of light from behind all volumes, or from the first surface, that reaches the "
         "camera, computed in closed form "
         "per camera ray (alpha is 1 minus an unbiased estimate of it)"},
        {Aov::OpticalDepth,
         "optical_depth",
         {"opticalDepth.Y"},
         true,
         "Optical depth of all volumes up to the first surface, in closed form per camera ray, "
         "mean over the pixel"},
        {Aov::Restir,
         "restir",
         {"restir.M", "restir.W", "restir.age"},
         true,
         "The pixel's reservoir, mean over the passes: confidence M [passes], contribution weight "
         "W, passes since its sample was drawn; 0 without reuse and of the path estimator"},
        {Aov::Cost,
         "cost",
         {"cost.Y"},
         true,
         "Exact rays per pass, camera ray and light rays together; 0 of the path estimator"},
        {Aov::Work,
         "work",
         {"work.candidates", "work.cells", "work.acceptance"},
         true,
         "Work per pass: candidates drawn, cells that the camera ray crossed, and of the "
         "reservoirs "
         "that reuse looked at (history, neighbours) the share that took part; 0 of the path "
         "estimator"},
        {Aov::Direct, "direct", rgb("direct"), false, "Radiance scattered once, by a surface"},
        {Aov::Indirect, "indirect", rgb("indirect"), false,
         "Radiance scattered twice or more, last by the surface that is seen"},
        {Aov::Emission, "emission", rgb("emission"), false,
         "Radiance given off by surfaces straight towards the camera"},
        {Aov::Normal,
         "N",
         {"N.X", "N.Y", "N.Z"},
         true,
         "Shading normal of the first surface on the camera ray, smoke in front or not, in the "
         "world, towards the camera; mean over the samples that meet one, 0: none"},
        {Aov::Position,
         "P",
         {"P.X", "P.Y", "P.Z"},
         true,
         "Place of the first surface on the camera ray, likewise [m]"},
        {Aov::MaterialId,
         "material_id",
         {"material_id.Y"},
         true,
         "Material of the first surface on the camera ray, smoke in front or not, as a whole "
         "number: of the pixel's samples that which meets one nearest, never a mean. 1, 2, ... in "
         "the order in which the scene's objects bring them, the same for all that look the same; "
         "0: no surface"},
    };
}

}  // namespace

std::span<const AovInfo> aov_table()
{
    static const std::vector<AovInfo> table = make_table();
    return table;
}

AovSet parse_aovs(const std::vector<std::string>& names)
{
    AovSet set;
    std::vector<std::string> known;
    for (const AovInfo& info : aov_table()) known.push_back(info.name);
    for (const std::string& name : names) {
        bool found = false;
        for (const AovInfo& info : aov_table()) {
            if (name != info.name) continue;
            set.add(info.aov);
            found = true;
        }
        if (found) continue;
        std::string list;
        for (const std::string& entry : known) list += (list.empty() ? "" : ", ") + entry;
        throw Error(ExitCode::Input, fmt::format("output.aovs: unknown layer \"{}\"{}; known: {}",
                                                 printable(name), did_you_mean(name, known), list));
    }
    return set;
}

}  // namespace mote
