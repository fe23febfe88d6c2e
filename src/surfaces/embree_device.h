#pragma once

#include <memory>

#include <embree3/rtcore.h>

namespace mote {

/// Embree's library state. The first mesh makes it, and it goes with the last.
class EmbreeDevice {
  public:
    EmbreeDevice();
    ~EmbreeDevice();
    EmbreeDevice(const EmbreeDevice&) = delete;
    EmbreeDevice& operator=(const EmbreeDevice&) = delete;

    [[nodiscard]] RTCDevice get() const { return device_; }

    /// Throws Error(Memory) or Error(RenderFailed) if an Embree call went wrong since the last
    /// time.
    void check() const;

  private:
    RTCDevice device_ = nullptr;
};

/// The one device of the process, made if there is none.
[[nodiscard]] std::shared_ptr<EmbreeDevice> embree_device();

/// Builds a scene's tree by the calling thread alone.
void commit_alone(RTCScene scene);

}  // namespace mote
