#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/camera.h"
#include "scene/light.h"
#include "surfaces/surfaces.h"
#include "volumes/tracking.h"

namespace mote {

/// Where things are one frame later, at equal ray times; tells how far they move on the film.
struct NextFrame {
    Camera camera;
    std::vector<MovingTransform> world_from_object;   ///< of each of Media::volumes
    std::vector<MovingTransform> world_from_surface;  ///< of each of Surfaces::objects
};

/// One frame, ready to render: everything evaluated at the frame's time, nothing of file formats.
struct Scene {
    Camera camera;
    Media media;
    std::vector<Light> lights;
    std::optional<EnvironmentLight> environment;
    std::shared_ptr<const Surfaces> surfaces;  ///< null: there are none
    /// Of each of Surfaces::objects: where in `lights` its triangles begin, one TriangleLight each;
    /// -1: it gives no light.
    std::vector<int> first_light_of_object;
    int frame = 1;
    double fps = 24.0;
    double shutter_open = 0.0;  ///< frames, relative to `frame`
    double shutter_close = 0.0;
    std::optional<NextFrame> next;  ///< only with PrepareNeeds::velocity
};

}  // namespace mote
