#pragma once

#include <vector>

#include "reference/trace_context.h"
#include "restir/smoke_lattice.h"
#include "volumes/phase_list.h"

namespace mote {

/// Light that has scattered twice or more, as it leaves the nodes of a lattice towards the camera:
/// of each phase function and node an estimate with the right mean, from paths of its own that no
/// pixel shares. In-scattered radiance [W/(m^2 sr)], the node's albedo left out.
///
/// Many pixels see the same nodes, so a frame pays for few paths. What interpolation between nodes
/// gets wrong nobody corrects: for previews.
struct ScatterNodes {
    SmokeLattice lattice;
    Vec3 eye{0.0f};  ///< where the camera is [m]
    PhaseList phases;
    std::vector<Spectrum> radiance;  ///< per phase function and slot; slot 0 is black
    double cpu_seconds = 0.0;

    [[nodiscard]] Spectrum at(size_t phase, int32_t slot) const
    {
        return radiance[phase * lattice.nodes.size() + static_cast<size_t>(slot)];
    }
    /// From a node to the camera [unit].
    [[nodiscard]] Vec3 wo(Vec3 node) const
    {
        const Vec3 to_eye = eye - node;
        const float distance = glm::length(to_eye);
        return distance > 0.0f ? to_eye / distance : Vec3(0.0f, 0.0f, 1.0f);
    }
};

/// How much is spent on nodes.
struct ScatterNodesParams {
    float paths = 1.0f;    ///< per pixel that smoke fills, and pass
    float spacing = 0.0f;  ///< of nodes [m]; 0: by the smoke's density and the pixels' size
    int passes = 1;        ///< of the frame
    uint32_t seed = 0;
};

/// Whether nodes can serve the scene: there is light of two events in media that camera rays may
/// meet, and nothing but the camera moves while the shutter is open (else a node's light and what
/// hides it from a pixel would belong to different times).
[[nodiscard]] bool can_have_scatter_nodes(const Scene& scene, const PathTracerParams& path);

/// Traces the nodes' paths, in parallel; most where the camera sees much of a node. Precondition:
/// can_have_scatter_nodes.
[[nodiscard]] ScatterNodes make_scatter_nodes(const TraceContext& context,
                                              const ScatterNodesParams& params);

}  // namespace mote
