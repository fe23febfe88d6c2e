#pragma once

#include <span>
#include <vector>

#include "core/box_tree.h"
#include "scene/light.h"

namespace mote {

/// Finds the lamps that rays meet and pass: spheres and quads. Triangles of meshes are the meshes'
/// business.
class LampSurfaces {
  public:
    LampSurfaces() = default;
    explicit LampSurfaces(std::span<const Light> lights);

    /// Calls f(index into the lights) for the lamps that a ray may meet.
    template <class F>
    void for_each_on_ray(const Ray& ray, F&& f) const
    {
        for (const int index : few_) f(index);
        tree_.for_each_on_ray(ray, f);
    }

    [[nodiscard]] bool is_empty() const { return few_.empty() && tree_.is_empty(); }

  private:
    std::vector<int> few_;  ///< tried one by one; if they are more, they are in the tree
    BoxTree tree_;
};

}  // namespace mote
