#include "surfaces/instance_bvh.h"

#include "core/error.h"
#include "surfaces/embree_device.h"

namespace mote {
namespace {

RTCQuaternionDecomposition decomposition(const Trs& trs)
{
    RTCQuaternionDecomposition out;
    rtcInitQuaternionDecomposition(&out);
    const Vec3 scale(trs.scale);
    const Vec3 shift(trs.translate);
    const glm::quat turn(trs.rotate);
    rtcQuaternionDecompositionSetScale(&out, scale.x, scale.y, scale.z);
    rtcQuaternionDecompositionSetQuaternion(&out, turn.w, turn.x, turn.y, turn.z);
    rtcQuaternionDecompositionSetTranslation(&out, shift.x, shift.y, shift.z);
    return out;
}

void set_transform(RTCGeometry geometry, const MovingTransform& transform)
{
    if (!transform.is_moving()) {
        const Affine affine = to_affine(matrix(transform.keys[0]));
        float columns[12];
        for (int c = 0; c < 4; ++c) {
            const Vec3 column = c < 3 ? affine.linear[c] : affine.offset;
            for (int r = 0; r < 3; ++r) columns[3 * c + r] = column[r];
        }
        rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
        return;
    }
    const size_t count = transform.keys.size();
    rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(count));
    for (size_t i = 0; i < count; ++i) {
        const RTCQuaternionDecomposition key = decomposition(transform.keys[i]);
        rtcSetGeometryTransformQuaternion(geometry, static_cast<unsigned>(i), &key);
    }
}

InstanceFrame embree_frame(RTCScene scene, size_t instance, float time)
{
    const RTCGeometry geometry = rtcGetGeometry(scene, static_cast<unsigned>(instance));
    float columns[12];
    rtcGetGeometryTransform(geometry, time, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
    InstanceFrame frame;
    for (int c = 0; c < 4; ++c) {
        const float* first = columns + static_cast<ptrdiff_t>(3) * c;
        const Vec3d column(first[0], first[1], first[2]);
        (c < 3 ? frame.linear[c] : frame.offset) = column;
    }
    frame.inverse = glm::inverse(frame.linear);
    return frame;
}

}  // namespace

InstanceBvh::InstanceBvh(std::vector<MeshInstance> instances)
    : instances_(std::move(instances)), device_(embree_device())
{
    MOTE_ASSERT(!instances_.empty());
    scene_ = rtcNewScene(device_->get());
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    for (size_t i = 0; i < instances_.size(); ++i) {
        const RTCGeometry geometry = rtcNewGeometry(device_->get(), RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(geometry, instances_[i].mesh->embree());
        set_transform(geometry, instances_[i].world_from_object);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene_, geometry, static_cast<unsigned>(i));
        rtcReleaseGeometry(geometry);
    }
    commit_alone(scene_);
    try {
        device_->check();
    } catch (...) {
        rtcReleaseScene(scene_);
        throw;
    }
    at_rest_.resize(instances_.size());
    for (size_t i = 0; i < instances_.size(); ++i) {
        if (instances_[i].world_from_object.is_moving()) continue;
        at_rest_[i] = embree_frame(scene_, i, 0.0f);
    }
}

InstanceBvh::~InstanceBvh()
{
    rtcReleaseScene(scene_);
}

InstanceFrame InstanceBvh::frame_at(size_t instance, float time) const
{
    if (!instances_[instance].world_from_object.is_moving()) return at_rest_[instance];
    return embree_frame(scene_, instance, time);
}

Bounds3 InstanceBvh::bounds() const
{
    RTCBounds box;
    rtcGetSceneBounds(scene_, &box);
    return {Vec3(box.lower_x, box.lower_y, box.lower_z),
            Vec3(box.upper_x, box.upper_y, box.upper_z)};
}

}  // namespace mote
