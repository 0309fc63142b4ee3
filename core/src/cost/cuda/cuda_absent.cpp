// Replaces the GPU backend in a build without a CUDA toolkit.
#include "cost/backends.hpp"
#include "cost/cuda/device.hpp"
#include "cost/cuda/memory/page_locked_images.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::cuda::internal {

std::string why_no_device(int) { return "this hypotrack was built without CUDA"; }

std::string why_not_this_device(int) { return why_no_device(); }

KeepDevice::KeepDevice() = default;
KeepDevice::~KeepDevice() = default;

bool claim_gpu(int) { return true; }

std::optional<std::size_t> free_memory(int) { return std::nullopt; }
void wait_for_device() {}

void page_lock_images(int, std::size_t) {}

Device::Device(int index) : index_(index) {
  throw DeviceError("evaluate.backend: cuda: " + why_no_device() +
                    ". Write `backend: cpu`, or build with -DHYPOTRACK_CUDA=ON");
}
Device::~Device() = default;
void Device::use() const {}

std::string why_not_evaluated(const Scene&, const std::vector<ObjectiveTerm>&,
                              const EvaluateSettings&, bool) {
  return why_no_device();
}

std::string why_not_linearized(const std::vector<ObjectiveTerm>&) { return {}; }

std::string why_neighbours_are_drawn(const std::vector<ObjectiveTerm>&) { return {}; }

std::unique_ptr<Cost> make_cost(const Scene&, std::vector<ObjectiveTerm>,
                                const EvaluateSettings& settings, bool) {
  const Device device(settings.device);
  return nullptr;
}

std::unique_ptr<Cost> make_egl_cost(const Scene&, const std::vector<ObjectiveTerm>&,
                                    const EvaluateSettings&, std::string& why_not) {
  why_not = why_no_device();
  return nullptr;
}

}  // namespace hypotrack::cuda::internal
