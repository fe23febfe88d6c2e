#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/camera.h"
#include "scene/light.h"
#include "volumes/tracking.h"

namespace mote {

/// Where things are one frame later, at equal ray times; tells how far they move on the film.
struct NextFrame {
    Camera camera;
    std::vector<MovingTransform> world_from_object;  ///< of each of Media::volumes
};

/// One frame, ready to render: everything evaluated at the frame's time, nothing of file formats.
struct Scene {
    Camera camera;
    Media media;
    std::vector<Light> lights;
    std::optional<EnvironmentLight> environment;
    int frame = 1;
    double fps = 24.0;
    double shutter_open = 0.0;  ///< frames, relative to `frame`
    double shutter_close = 0.0;
    std::optional<NextFrame> next;  ///< only with PrepareNeeds::velocity
};

}  // namespace mote
