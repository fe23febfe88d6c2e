#include "scene/fields.h"

namespace mote {
namespace {

constexpr std::array material_names = {"diffuse", "metallic_roughness", "dielectric"};

void visit_files(FieldVisitor& v, MaterialFiles& files)
{
    visit(v,
          {.key = "color_texture",
           .doc = "Picture (.png, .jpg, .exr, .hdr) that multiplies `color`, by the mesh's texture "
                  "coordinates; repeated without end",
           .also = "texture map base_color_texture albedo_texture diffuse_texture"},
          files.color);
    visit(v,
          {.key = "roughness_texture",
           .doc = "Its green multiplies `roughness`; grey pictures and glTF's serve alike",
           .also = "metallic_roughness_texture",
           .used_by = "metallic_roughness dielectric"},
          files.roughness);
    visit(v,
          {.key = "metallic_texture",
           .doc = "Its blue multiplies `metallic`",
           .used_by = "metallic_roughness"},
          files.metallic);
    visit(v,
          {.key = "normal_texture",
           .doc = "Tangent-space normal map, green upwards (OpenGL's)",
           .also = "normal_map bump bump_texture"},
          files.normal);
    visit(v,
          {.key = "normal_strength",
           .doc = "Multiplies the slopes of `normal_texture`",
           .range = between(0, 1000)},
          files.normal_strength);
    visit(v,
          {.key = "emission_texture", .doc = "Multiplies `emission`", .also = "emissive_texture"},
          files.emission);
    visit(v,
          {.key = "alpha_cutoff",
           .doc = "Where the alpha of `color_texture` is below, there is no surface; 0: everywhere "
                  "is. JPEG has no alpha",
           .range = between(0, 1),
           .also = "alpha opacity cutout mask"},
          files.alpha_cutoff);
}

}  // namespace

void describe(FieldVisitor& v, MaterialDescription& material)
{
    Material& look = material.look;
    visit(v,
          {.key = "name",
           .doc = "The name that objects use; in an object's `material`: the [[materials]] entry "
                  "to use, without other keys",
           .also = "use"},
          material.name);
    visit_choice(v,
                 {.key = "type",
                  .doc = "diffuse is matt; metallic_roughness is plastic or metal, as in glTF; "
                         "dielectric is glass or water",
                  .also = "kind"},
                 look.kind, material_names);
    v.select(material_names[static_cast<size_t>(look.kind)]);
    visit(v,
          {.key = "color",
           .doc = "Share of the light that comes back; dielectric: that passes. One number or RGB",
           .range = between(0, 1),
           .also = "base_color albedo reflectance colour tint",
           .scalar_ok = true},
          look.base_color);
    visit(v,
          {.key = "metallic",
           .doc = "0: plastic, 1: metal",
           .range = between(0, 1),
           .also = "metalness",
           .used_by = "metallic_roughness"},
          look.metallic);
    visit(
        v,
        {.key = "roughness",
         .doc = "0: as good as smooth, 1: very rough. Light that meets the rough surface's facets "
                "twice is lost, as in glTF's model: with roughness 1 up to 70 % of a metal's and "
                "a third of glass's",
         .range = between(0, 1),
         .also = "alpha glossiness",
         .used_by = "metallic_roughness dielectric"},
        look.roughness);
    visit(v,
          {.key = "ior",
           .doc = "Index of refraction, inside over outside",
           .range = between(1, 4),
           .also = "eta index",
           .used_by = "dielectric"},
          look.ior);
    visit(v,
          {.key = "emission",
           .doc = "Radiance given off; such objects stand still while the shutter is open",
           .unit = "W/(m^2 sr)",
           .range = between(0, 1e20),
           .also = "strength emissive radiance"},
          material.emission);
    visit(v,
          {.key = "emission_color",
           .doc = "Multiplies `emission`; one number or RGB",
           .range = between(0, 1e6),
           .scalar_ok = true},
          material.emission_color);
    visit(v,
          {.key = "two_sided",
           .doc = "Both sides look alike; else the back is black and dark. Of no meaning for glass",
           .also = "doubleSided double_sided"},
          look.two_sided);
    visit_files(v, material.files);
}

void describe(FieldVisitor& v, ObjectDescription& object)
{
    visit(v, {.key = "name", .doc = "For messages and overrides"}, object.name);
    visit_table(
        v,
        {.key = "file",
         .doc = "Mesh (.obj, .ply) or glTF file (.gltf, .glb), one or a sequence; text alone is "
                "its `path`. Vertices reach to 1e9 in the file and, once placed, to 1e7 m from the "
                "origin",
         .required = true,
         .also = "mesh path obj ply gltf glb",
         .shorthand = "path"},
        object.file);
    const Field material{.key = "material",
                         .doc =
                             "What it is made of; text alone is the `name` of a [[materials]] "
                             "entry. Default: what a glTF file says, else a matt grey",
                         .also = "color",
                         .shorthand = "name"};
    const bool has_material = v.has(material, object.has_material);
    if (v.assigns()) object.has_material = has_material;
    if (has_material) visit_table(v, material, object.material);
    visit_transform(v, object.transform);
}

}  // namespace mote
