#include "restir/transmittance_map.h"

#include "core/parallel.h"
#include "volumes/cell_walk.h"
#include "volumes/media_extent.h"

namespace mote {
namespace {

/// The media's box in oblique axes of unit length: those of the largest grid, so that a single
/// rotated cloud is boxed tightly.
struct OrientedBox {
    glm::dmat3 axes{1.0};  ///< columns, in world space
    Vec3d centre{0.0};     ///< world space [m]
    Vec3d lo{0.0};         ///< along the axes, from the centre [m]
    Vec3d hi{0.0};
};

std::optional<OrientedBox> box_of(const Media& media)
{
    OrientedBox box;
    double largest = 0.0;
    for (const Volume& volume : media.volumes) {
        if (is_void(volume)) continue;
        const Mat4d m = world_from_local(volume, cache_time);
        const Bounds3 local = local_bounds(*volume.density);
        const Vec3d extent(local.extent());
        const double size =
            std::abs(glm::determinant(glm::dmat3(m))) * extent.x * extent.y * extent.z;
        if (!(size > largest)) continue;
        largest = size;
        for (int i = 0; i < 3; ++i) box.axes[i] = glm::normalize(Vec3d(m[i]));
        box.centre = Vec3d(m * glm::dvec4(Vec3d(local.centre()), 1.0));
    }
    if (largest == 0.0) return std::nullopt;
    // A float origin, so that lookups subtract the very same point.
    box.centre = Vec3d(Vec3(box.centre));
    box.lo = Vec3d(std::numeric_limits<double>::infinity());
    box.hi = -box.lo;
    const glm::dmat3 from_world = glm::inverse(box.axes);
    for (const Volume& volume : media.volumes) {
        if (is_void(volume)) continue;
        const Mat4d m = world_from_local(volume, cache_time);
        const Bounds3 local = local_bounds(*volume.density);
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3 p(corner & 1 ? local.hi.x : local.lo.x, corner & 2 ? local.hi.y : local.lo.y,
                         corner & 4 ? local.hi.z : local.lo.z);
            const Vec3d q = from_world * (Vec3d(m * glm::dvec4(Vec3d(p), 1.0)) - box.centre);
            box.lo = glm::min(box.lo, q);
            box.hi = glm::max(box.hi, q);
        }
    }
    const Vec3d extent = box.hi - box.lo;
    if (!(glm::length(extent) < 1e15)) return std::nullopt;  // or no number
    return box;
}

/// Rays parallel to the light, sheared along the axis a that it runs along most. Lattice
/// coordinates: two across the rays, then the plane number, counted from the light's side.
struct RayLattice {
    Vec3i count{2};            ///< rays, rays, planes
    glm::dmat3 from_box{1.0};  ///< box coordinates -> lattice
    Vec3d offset{0.0};
    double step = 0.0;  ///< world distance between planes along a ray [m]

    [[nodiscard]] int64_t nodes() const { return int64_t{count.x} * count.y * count.z; }
};

RayLattice lattice_for(const OrientedBox& box, Vec3d w, double spacing)
{
    const Vec3d size = glm::abs(w);
    const int a = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    const double depth = box.hi[a] - box.lo[a];
    // Distance from the light's face of the box along axis a: z = towards * q[a] + from.
    const double towards = w[a] > 0.0 ? -1.0 : 1.0;
    const double from = w[a] > 0.0 ? box.hi[a] : -box.lo[a];
    const auto count_for = [&](double length) {
        return static_cast<int>(std::min(1e6, std::ceil(length / spacing)));
    };
    RayLattice lattice;
    glm::dmat3 rows(0.0);  // filled by rows, transposed at the end
    for (int i = 0; i < 2; ++i) {
        const int axis = (a + 1 + i) % 3;
        const double shear = w[axis] / size[a];
        const double lo = box.lo[axis] + std::min(0.0, shear * depth);
        const double hi = box.hi[axis] + std::max(0.0, shear * depth);
        // One spacing to spare: the outermost rays pass outside all media, so that whatever lies
        // beside them is clamped to depth 0.
        lattice.count[i] = count_for(hi - lo) + 2;
        const double first = 0.5 * (lo + hi) - 0.5 * spacing * (lattice.count[i] - 1);
        rows[i][axis] = 1.0 / spacing;
        rows[i][a] = shear * towards / spacing;
        lattice.offset[i] = (shear * from - first) / spacing;
    }
    lattice.count.z = count_for(depth) + 1;
    rows[2][a] = towards / spacing;
    lattice.offset.z = from / spacing;
    lattice.from_box = glm::transpose(rows);
    lattice.step = spacing / size[a];
    return lattice;
}

RayLattice lattice_within(int64_t budget, const OrientedBox& box, Vec3d w, double& spacing)
{
    for (;;) {
        RayLattice lattice = lattice_for(box, w, spacing);
        const double excess = static_cast<double>(lattice.nodes()) /
                              static_cast<double>(std::max<int64_t>(budget, 18));
        if (excess <= 1.0) return lattice;
        spacing *= std::max(1.02, std::cbrt(excess));
    }
}

/// Writes the depths of one ray at its planes while the ray is walked.
struct PlaneWriter {
    float* depths;
    int count;
    float step;   ///< world distance between planes [m]
    float t0;     ///< world distance at which the walk starts [m]
    float scale;  ///< sigma_t per density
    float max_depth;
    float depth = 0.0f;   ///< so far
    int plane = 0;        ///< next to write
    float next_s = 0.0f;  ///< its distance from the start of the walk

    void start()
    {
        plane = static_cast<int>(std::ceil(t0 / step));
        set_next();
    }

    void set_next() { next_s = static_cast<float>(plane) * step - t0; }

    /// Takes one piece of the ray; false when nothing more matters.
    bool add(const CellSpan& cell)
    {
        while (next_s <= cell.s1 && plane < count) {
            depths[plane++] += depth + scale * integral_to(cell, next_s);
            set_next();
        }
        depth += scale * cell.integral();
        return depth < max_depth && plane < count;
    }

    void finish()
    {
        for (; plane < count; ++plane) depths[plane] += depth;
    }

    /// Integral from the cell's start to s, by the parabola through its three densities.
    static float integral_to(const CellSpan& cell, float s)
    {
        const float length = cell.s1 - cell.s0;
        const float f = length > 0.0f ? std::clamp((s - cell.s0) / length, 0.0f, 1.0f) : 0.0f;
        const float slope = 4.0f * cell.vm - 3.0f * cell.v0 - cell.v1;
        const float bend = 2.0f * (cell.v0 - 2.0f * cell.vm + cell.v1);
        return std::max(0.0f, length * f * (cell.v0 + f * (0.5f * slope + f * bend / 3.0f)));
    }
};

void add_volume(const Volume& volume, const GridFrame& frame, const Ray& ray,
                const RayLattice& lattice, float max_depth, float* depths)
{
    const BrickGrid& grid = *volume.density;
    const LocalRay local = make_local_ray(grid, frame, ray, {0.0f, infinity});
    if (local.misses()) return;
    PlaneWriter writer{depths,
                       lattice.count.z,
                       static_cast<float>(lattice.step),
                       static_cast<float>(local.t0),
                       volume.density_scale,
                       max_depth};
    writer.start();
    for_each_brick(grid, local, [&](const BrickSpan& span) {
        const BrickRange& range = grid.ranges[static_cast<size_t>(span.brick)];
        if (range.min == range.max) {
            return writer.add({span.s0, span.s1, range.max, range.max, range.max});
        }
        return for_each_cell(grid, local, span,
                             [&](const CellSpan& cell) { return writer.add(cell); });
    });
    writer.finish();
}

/// Optical depth that lets nothing through.
constexpr float opaque = 100.0f;

/// Makes the ray's planes behind the first surface opaque, seen from the light, which is `reach`
/// before the first plane.
void add_shadow(const Surfaces& surfaces, const Ray& ray, float reach, const RayLattice& lattice,
                float* depths)
{
    const Ray from_light{ray.o - reach * ray.d, ray.d, ray.time};
    const std::optional<SurfaceHit> hit = intersect(surfaces, from_light, {0.0f, infinity});
    if (!hit) return;
    const double z = static_cast<double>(hit->t - reach) / lattice.step;
    const int first = static_cast<int>(std::clamp(std::ceil(z), 0.0, 1.0 * lattice.count.z));
    for (int plane = first; plane < lattice.count.z; ++plane) depths[plane] += opaque;
}

}  // namespace

void TransmittanceMap::clear()
{
    depths_.assign(8, 0.0f);
}

TransmittanceMap::TransmittanceMap(const Media& media, Vec3 wi,
                                   const TransmittanceMapParams& params, const Surfaces* surfaces)
{
    clear();
    const double start = process_cpu_seconds();
    const std::optional<OrientedBox> box = box_of(media);
    const float length = glm::length(wi);
    if (!box || !(length > 0.5f && length < 2.0f)) return;
    const Vec3d w = glm::inverse(box->axes) * Vec3d(wi / length);
    double spacing =
        static_cast<double>(params.spacing > 0.0f ? params.spacing : 2.0f * finest_voxel(media));
    const RayLattice lattice = lattice_within(params.node_budget, *box, w, spacing);

    centre_ = Vec3(box->centre);
    lattice_from_world_ = {Mat3(lattice.from_box * glm::inverse(box->axes)), Vec3(lattice.offset)};
    last_ = Vec3(lattice.count - 1);
    last_cell_ = lattice.count - 2;
    planes_ = static_cast<size_t>(lattice.count.z);
    line_ = planes_ * static_cast<size_t>(lattice.count.x);
    depths_.assign(static_cast<size_t>(lattice.nodes()), 0.0f);
    spacing_ = static_cast<float>(spacing);

    struct Walked {
        const Volume* volume;
        GridFrame frame;
    };
    std::vector<Walked> walked;
    for (const Volume& volume : media.volumes) {
        if (!is_void(volume)) walked.push_back({&volume, frames_at(volume, cache_time).density});
    }
    float reach = 0.0f;
    if (surfaces) {
        Bounds3 all = surfaces->bvh->bounds();
        all.extend(centre_);
        reach = glm::length(all.extent());
    }
    const glm::dmat3 box_from_lattice = glm::inverse(lattice.from_box);
    const auto columns = static_cast<size_t>(lattice.count.x);
    const size_t rays = columns * static_cast<size_t>(lattice.count.y);
    parallel_for(rays, 32, [&](size_t begin, size_t end) {
        for (size_t n = begin; n < end; ++n) {
            const size_t line = n / columns;
            const Vec3d node(static_cast<double>(n % columns), static_cast<double>(line), 0.0);
            const Vec3d q = box_from_lattice * (node - lattice.offset);
            const Ray ray{Vec3(box->centre + box->axes * q), -wi / length, cache_time};
            for (const Walked& one : walked) {
                add_volume(*one.volume, one.frame, ray, lattice, params.max_depth,
                           depths_.data() + n * planes_);
            }
            if (surfaces) add_shadow(*surfaces, ray, reach, lattice, depths_.data() + n * planes_);
        }
    });
    stats_.rays = static_cast<int64_t>(rays);
    stats_.nodes = lattice.nodes();
    stats_.bytes = stats_.nodes * static_cast<int64_t>(sizeof(float));
    stats_.cpu_seconds = process_cpu_seconds() - start;
}

}  // namespace mote
