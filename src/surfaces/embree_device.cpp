#include "surfaces/embree_device.h"

#include <atomic>
#include <mutex>

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include "core/error.h"
#include "surfaces/mesh_bvh.h"

namespace mote {
namespace {

std::atomic<int> devices_made{0};

}  // namespace

EmbreeDevice::EmbreeDevice() : device_(rtcNewDevice(nullptr))
{
    check();
    ++devices_made;
}

EmbreeDevice::~EmbreeDevice()
{
    rtcReleaseDevice(device_);
}

void EmbreeDevice::check() const
{
    const RTCError error = rtcGetDeviceError(device_);
    if (error == RTC_ERROR_NONE) return;
    if (error == RTC_ERROR_OUT_OF_MEMORY) {
        throw Error(ExitCode::Memory, "not enough memory for the meshes");
    }
    throw Error(ExitCode::RenderFailed, fmt::format("Embree error {}", static_cast<int>(error)));
}

std::shared_ptr<EmbreeDevice> embree_device()
{
    static std::mutex mutex;
    static std::weak_ptr<EmbreeDevice> current;
    const std::lock_guard lock(mutex);
    std::shared_ptr<EmbreeDevice> device = current.lock();
    if (!device) {
        device = std::make_shared<EmbreeDevice>();
        current = device;
    }
    return device;
}

void commit_alone(RTCScene scene)
{
    tbb::task_arena alone(1);
    alone.execute([&] { rtcCommitScene(scene); });
}

int embree_devices_made()
{
    return devices_made;
}

}  // namespace mote
