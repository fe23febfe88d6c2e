#include "scene/fields.h"

namespace mote {
namespace {

constexpr std::array light_names = {"point", "spot", "distant", "sphere", "quad", "environment"};

}  // namespace

void describe(FieldVisitor& v, LightDescription& light)
{
    visit(v, {.key = "name", .doc = "For messages and overrides"}, light.name);
    visit_choice(v, {.key = "type", .doc = "Kind of light", .required = true, .also = "kind"},
                 light.kind, light_names);
    v.select(light_names[static_cast<size_t>(light.kind)]);
    visit(v,
          {.key = "color",
           .doc = "Multiplies `strength`; one number or RGB",
           .range = between(0, 1e6),
           .also = "colour tint",
           .scalar_ok = true},
          light.color);
    visit(v,
          {.key = "strength",
           .doc = "point, spot: intensity [W/sr]; distant: irradiance [W/m^2]; others: radiance "
                  "[W/(m^2 sr)]",
           .range = between(0, 1e20),
           .also = "intensity radiance irradiance power energy"},
          light.strength);
    visit(v,
          {.key = "position",
           .doc = "Centre; quad: a corner",
           .unit = "m",
           .range = length_range,
           .used_by = "point spot sphere quad"},
          light.position);
    visit(v,
          {.key = "direction",
           .doc = "distant: towards the light; spot: where it shines; any length",
           .range = length_range,
           .used_by = "distant spot"},
          light.direction);
    visit(v,
          {.key = "cone_angle",
           .doc = "Of the cone, from side to side",
           .unit = "degrees",
           .range = Range{0.0, 180.0, true, false},
           .also = "angle cone spot_angle spot_size",
           .used_by = "spot"},
          light.cone_angle);
    visit(v,
          {.key = "blend",
           .doc = "Share of the cone that fades towards its edge; 0: sharp",
           .range = between(0, 1),
           .also = "inner_angle penumbra softness",
           .used_by = "spot"},
          light.blend);
    visit(v,
          {.key = "radius",
           .doc = "Radius of the sphere",
           .unit = "m",
           .range = size_range,
           .used_by = "sphere"},
          light.radius);
    visit(v,
          {.key = "edge_u",
           .doc = "First edge; the light goes along edge_u x edge_v",
           .unit = "m",
           .range = length_range,
           .used_by = "quad"},
          light.edge_u);
    visit(v,
          {.key = "edge_v",
           .doc = "Second edge",
           .unit = "m",
           .range = length_range,
           .used_by = "quad"},
          light.edge_v);
    visit(v, {.key = "two_sided", .doc = "Shine to both sides", .used_by = "quad"},
          light.two_sided);
    visit(v,
          {.key = "image",
           .doc = "Latitude-longitude picture (.exr, .hdr, .png, .jpg), multiplied by "
                  "colour and strength",
           .also = "map file texture",
           .used_by = "environment"},
          light.image);
    visit(v,
          {.key = "count",
           .doc = "A swarm: this many copies, scattered over `spread`",
           .range = between(1, 1'000'000),
           .used_by = "point spot sphere"},
          light.count);
    visit(v,
          {.key = "spread",
           .doc = "Edges of the box around `position` that holds the copies",
           .unit = "m",
           .range = between(0, 1e7),
           .used_by = "point spot sphere",
           .scalar_ok = true},
          light.spread);
    visit(
        v,
        {.key = "seed", .doc = "Chooses the places of the copies", .used_by = "point spot sphere"},
        light.seed);
    visit(v,
          {.key = "particles",
           .doc = "A lamp for each particle of the [[particles]] system of this name, in its place "
                  "at the middle of the shutter, at most a million; instead of `position`, "
                  "`radius` and `count`",
           .used_by = "sphere"},
          light.particles);
    visit(v,
          {.key = "radius_scale",
           .doc = "With `particles`: radius of the lamps over that of the particles",
           .range = Range{0.0, 1e6, true, false},
           .used_by = "sphere"},
          light.radius_scale);
    visit(v,
          {.key = "use_color",
           .doc = "With `particles`: their colours multiply the radiance",
           .used_by = "sphere"},
          light.use_color);
    visit(v,
          {.key = "use_temperature",
           .doc = "With `particles`: they glow by their temperature T, as black bodies do: the "
                  "radiance is `color` times `strength` at 1500 K, and (T/1500 K)^4 times that in "
                  "T's hue",
           .used_by = "sphere"},
          light.use_temperature);
    visit_list(v,
               {.key = "keys",
                .doc = "Keyframes of its brightness, ascending; each value runs linearly between "
                       "the keys that give it and replaces the one above",
                .also = "keyframes animation"},
               light.keys);
    visit_transform(v, light.transform);
}

void describe(FieldVisitor& v, LightKey& key)
{
    visit(v,
          {.key = "frame", .doc = "When", .unit = "frames", .range = frame_range, .required = true},
          key.frame);
    visit_optional(v, {.key = "strength", .doc = "As in [[lights]]", .range = between(0, 1e20)},
                   key.strength);
    visit_optional(
        v, {.key = "color", .doc = "As in [[lights]]", .range = between(0, 1e6), .scalar_ok = true},
        key.color);
}

void describe(FieldVisitor& v, TransformKey& key)
{
    visit(v,
          {.key = "frame",
           .doc = "When; needed for two and more keys",
           .unit = "frames",
           .range = frame_range},
          key.frame);
    visit(v,
          {.key = "translate",
           .doc = "Shift, applied last",
           .unit = "m",
           .range = length_range,
           .also = "position"},
          key.translate);
    visit(v,
          {.key = "rotate",
           .doc = "Turns about x, then y, then z; 0 to 360 is a full turn",
           .unit = "degrees",
           .range = between(-1e6, 1e6)},
          key.rotate);
    visit(v,
          {.key = "scale",
           .doc = "Size, applied first; one number or one per axis, not 0",
           .range = between(-1e6, 1e6),
           .scalar_ok = true},
          key.scale);
}

void visit_transform(FieldVisitor& v, std::vector<TransformKey>& keys)
{
    visit_list(v,
               {.key = "transform",
                .doc = "Places the object in the world: one table, or keyframes",
                .also = "translate rotate keys",
                .carries = true,
                .single_ok = true},
               keys);
}

}  // namespace mote
