#include "multiscatter/shift_path.h"

namespace mote {

std::optional<ShiftedPath> shift_path(const ReusedPath& y, const PathEndpoint& from,
                                      const PathEndpoint& to, const PathMap& map)
{
    const std::optional<ShiftedNumber> number =
        shift_number(map.kind, y.u, from.end(), to.end(), map.ray);
    if (!number) return std::nullopt;
    ShiftedPath out{y, number->jacobian};
    out.y.u = number->u;
    if (y.form != PathForm::Replay) {
        out.y.x2 = y.x2 + map.motion;
        const RayPoint first = point_at(to.world.frame, to.domain, out.y.u);
        out.y.r = glm::length(out.y.x2 - first.x);
        out.jacobian *= sqr(y.r / out.y.r);
        float ignored = 0.0f;
        if (map.suffix == SuffixRule::Traced) find_light(to.world, out.y, ignored);
    }
    out.f = eval_path(to.world, to.domain, out.y);
    if (!(max_component(out.f) > 0.0f)) return std::nullopt;
    return out;
}

}  // namespace mote
