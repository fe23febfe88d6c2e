#pragma once

#include "surfaces/surfaces.h"

namespace mote::test {

/// Surfaces of one instance.
inline Surfaces make_surfaces(Mesh mesh, const Trs& trs)
{
    MeshInstance instance{std::make_shared<const MeshBvh>(std::move(mesh)), {}};
    instance.world_from_object.keys = {trs};
    Surfaces surfaces;
    surfaces.objects = {{"thing", 0}};
    surfaces.materials = {Material{}};
    surfaces.bvh = std::make_shared<const InstanceBvh>(std::vector<MeshInstance>{instance});
    return surfaces;
}

}  // namespace mote::test
