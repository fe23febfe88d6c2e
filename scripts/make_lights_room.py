#!/usr/bin/env python3
"""Writes scenes/bench_lights_room.toml and scenes/meshes/chips.obj: a closed room with 10,000 small
glowing triangles whose power spans five orders of magnitude. Run it in the repository's root."""
import math
import random

CHIPS = 250
GROUPS = 40

random.seed(7)


def chip(out, index):
    """A triangle somewhere in the unit cube; sizes are log-normal."""
    centre = [random.random() for _ in range(3)]
    size = 0.004 * math.exp(random.gauss(0.0, 0.6))
    for _ in range(3):
        p = [c + size * random.gauss(0.0, 1.0) for c in centre]
        out.append("v %.4f %.4f %.4f" % tuple(p))
    out.append("f %d %d %d" % (3 * index + 1, 3 * index + 2, 3 * index + 3))


lines = ["# 250 chips: written by scripts/make_lights_room.py"]
for i in range(CHIPS):
    chip(lines, i)
with open("scenes/meshes/chips.obj", "w") as f:
    f.write("\n".join(lines) + "\n")

HEAD = """# A closed room with 10,000 glowing triangles, from dim to bright over five orders of magnitude, in
# clouds below its ceiling and around the camera, out of view. Written by scripts/make_lights_room.py.
name = "Room with 10,000 lights"

[camera]
fov = 42
keys = [ { frame = 1, position = [-0.5, 1.7, 3.6], look_at = [-0.1, 0.55, -1] },
         { frame = 48, position = [0.7, 1.6, 3.3], look_at = [0.1, 0.55, -1] } ]

[render]
width = 480
height = 270
samples = 16
bounces = 1
estimator = "restir"

[output]
path = "out/bench_lights_room.exr"
preview = "out/bench_lights_room.png"

[[materials]]
name = "white"
color = 0.7

[[objects]]
name = "walls"
file = "meshes/cube.obj"
material = { color = [0.7, 0.66, 0.6] }
transform = { translate = [0, 1.5, 0], scale = [6, 3, 8.4] }

[[objects]]
name = "table"
file = "meshes/cube.obj"
material = "white"
transform = { translate = [0.3, 0.6, -0.6], rotate = [0, 25, 0], scale = [1.8, 0.1, 1.0] }

[[objects]]
name = "block"
file = "meshes/cube.obj"
material = { color = [0.3, 0.45, 0.7] }
transform = [ { frame = 1, translate = [-1.5, 0.5, -0.9], rotate = [0, -15, 0], scale = [0.7, 1.0, 0.7] },
              { frame = 48, translate = [-1.1, 0.5, -0.4], rotate = [0, 75, 0], scale = [0.7, 1.0, 0.7] } ]

[[objects]]
name = "ball"
file = "meshes/ball.obj"
material = { type = "metallic_roughness", color = [0.9, 0.75, 0.5], metallic = 1, roughness = 0.35 }
transform = { translate = [0.4, 0.95, -0.6], scale = 0.3 }

[[objects]]
name = "glossy ball"
file = "meshes/ball.obj"
material = { type = "metallic_roughness", color = [0.5, 0.1, 0.1], roughness = 0.4 }
transform = [ { frame = 1, translate = [1.7, 0.4, 0.5], scale = 0.4 },
              { frame = 48, translate = [1.3, 0.4, -0.5], scale = 0.4 } ]
"""

GROUP = """
[[objects]]
name = "chips %d"
file = "meshes/chips.obj"
material = { color = 0.1, emission = %.3g, emission_color = [%.2f, %.2f, %.2f] }
transform = { translate = [%.2f, %.2f, %.2f], rotate = [%d, %d, %d], scale = [%.2f, %.2f, %.2f] }
"""


def box(kind):
    """Corner and size of a cloud of chips: below the ceiling, or on the walls beside the camera."""
    if kind < 2:
        return [random.uniform(-2.8, 1.6), 2.5, random.uniform(-3.0, 2.0)], [1.2, 0.4, 1.2]
    x = -2.9 if kind == 2 else 2.6
    return [x, random.uniform(0.2, 2.0), random.uniform(2.2, 2.8)], [0.3, 0.8, 1.2]


with open("scenes/bench_lights_room.toml", "w") as f:
    f.write(HEAD)
    for i in range(GROUPS):
        corner, size = box(i % 4)
        strength = 10.0 ** random.uniform(-1.0, 3.2)
        warm = random.random()
        color = (1.0, 0.55 + 0.4 * (1.0 - warm), 0.2 + 0.8 * (1.0 - warm))
        f.write(GROUP % ((i, strength) + color + tuple(corner) + (0, 0, 0) + tuple(size)))
