// Stands in for the GPU backend in a build without a CUDA toolkit.
#include "cuda/device.hpp"
#include "hypotrack/error.hpp"

namespace hypotrack::cuda {

std::string why_no_device(int) { return "this hypotrack was built without CUDA"; }

Device::Device(int index) : index_(index) {
  throw DeviceError("evaluate.backend: cuda: " + why_no_device() +
                    ". Write `backend: cpu`, or build with -DHYPOTRACK_CUDA=ON");
}
Device::~Device() = default;
void Device::use() const {}

}  // namespace hypotrack::cuda
