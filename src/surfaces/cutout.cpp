#include "surfaces/cutout.h"

#include "core/error.h"
#include "surfaces/surfaces.h"

namespace mote {

SurfaceQuery::SurfaceQuery(const Surfaces& of) : surfaces(&of)
{
    rtcInitIntersectContext(&embree);
    if (of.has_cuts) embree.filter = reject_cut_out;
}

void reject_cut_out(const RTCFilterFunctionNArguments* arguments)
{
    MOTE_ASSERT(arguments->N == 1);
    if (arguments->valid[0] == 0) return;
    const auto* query = reinterpret_cast<const SurfaceQuery*>(arguments->context);
    const Surfaces& surfaces = *query->surfaces;
    const auto object = static_cast<int>(RTCHitN_instID(arguments->hit, 1, 0, 0));
    const MaterialTextures* textures = surfaces.textures_of(object);
    if (!textures || !textures->is_cut()) return;
    const Vec2 uv = uv_at(surfaces.mesh(object), RTCHitN_primID(arguments->hit, 1, 0),
                          RTCHitN_u(arguments->hit, 1, 0), RTCHitN_v(arguments->hit, 1, 0));
    if (!is_present(*textures, uv)) arguments->valid[0] = 0;
}

}  // namespace mote
