#include "volumes/procedural.h"

#include <cmath>

#include <fmt/core.h>
#include <openvdb/tools/Prune.h>

#include "core/error.h"
#include "core/parallel.h"
#include "volumes/make_bricks.h"
#include "volumes/procedural_bricks.h"
#include "volumes/procedural_density.h"

namespace mote {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

void check(const ProceduralParams& params, const GridBudget& budget, Vec3i count)
{
    const bool good = is_finite(params.size) && params.size.x > 0.0f && params.size.y > 0.0f &&
                      params.size.z > 0.0f && params.voxel_size > 0.0f &&
                      std::isfinite(params.voxel_size) && params.noise >= 0.0f &&
                      params.noise <= 1.0f && std::isfinite(params.evolve);
    if (!good) {
        throw Error(ExitCode::Input,
                    fmt::format("procedural volume: size and voxel_size must be positive and noise "
                                "in [0,1] (size {} x {} x {} m, voxel_size {} m, noise {})",
                                params.size.x, params.size.y, params.size.z, params.voxel_size,
                                params.noise));
    }
    const double voxels = static_cast<double>(count.x) * count.y * count.z;
    if (voxels > static_cast<double>(budget.max_voxels)) {
        throw Error(ExitCode::Memory,
                    fmt::format("procedural volume: {:.3g} voxels but the limit is {:.3g}; raise "
                                "voxel_size",
                                voxels, static_cast<double>(budget.max_voxels)));
    }
}

}  // namespace

openvdb::FloatGrid::Ptr make_procedural(const ProceduralParams& params, double time_s,
                                        const GridBudget& budget)
{
    const Vec3 exact = glm::min(glm::ceil(params.size / params.voxel_size), Vec3(1e9f));
    const Vec3i count(glm::max(Vec3i(exact), Vec3i(1)));
    check(params, budget, count);
    const ProceduralDensity density(params, time_s);
    // Voxel (0,0,0) is centred half a voxel inside the low corner of the box.
    const Vec3i blocks = (count + 7) / 8;
    const size_t block_count = static_cast<size_t>(blocks.x) * static_cast<size_t>(blocks.y) *
                               static_cast<size_t>(blocks.z);
    std::vector<std::unique_ptr<Leaf>> leaves(block_count);
    parallel_for(block_count, 16, [&](size_t begin, size_t end) {
        float values[512];
        for (size_t i = begin; i != end; ++i) {
            const Vec3i block(
                static_cast<int>(i % static_cast<size_t>(blocks.x)),
                static_cast<int>(i / static_cast<size_t>(blocks.x) % static_cast<size_t>(blocks.y)),
                static_cast<int>(i / static_cast<size_t>(blocks.x) /
                                 static_cast<size_t>(blocks.y)));
            bool any = false;
            for (int j = 0; j < 512; ++j) {
                const Vec3i c = block * 8 + Vec3i(j / 64, j / 8 % 8, j % 8);
                const bool inside = c.x < count.x && c.y < count.y && c.z < count.z;
                values[j] = inside ? density.at(c) : 0.0f;
                any = any || values[j] > 0.0f;
            }
            if (!any) continue;
            auto leaf = std::make_unique<Leaf>(
                openvdb::Coord(block.x * 8, block.y * 8, block.z * 8), 0.0f, false);
            for (openvdb::Index j = 0; j < 512; ++j) {
                if (values[j] > 0.0f) leaf->setValueOn(j, values[j]);
            }
            leaves[i] = std::move(leaf);
        }
    });
    auto grid = openvdb::FloatGrid::create(0.0f);
    for (auto& leaf : leaves) {
        if (leaf) grid->tree().addLeaf(leaf.release());
    }
    openvdb::tools::pruneTiles(grid->tree());
    const double voxel = static_cast<double>(params.voxel_size);
    auto transform = openvdb::math::Transform::createLinearTransform(voxel);
    transform->postTranslate(openvdb::Vec3d(0.5 * (voxel - static_cast<double>(params.size.x)),
                                            0.5 * (voxel - static_cast<double>(params.size.y)),
                                            0.5 * (voxel - static_cast<double>(params.size.z))));
    grid->setTransform(transform);
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    return grid;
}

std::shared_ptr<const BrickGrid> make_procedural_bricks(const ProceduralParams& params,
                                                        double time_s, const GridBudget& budget)
{
    GridLoadReport report;
    return make_bricks(*make_procedural(params, time_s, budget), budget, report);
}

}  // namespace mote
