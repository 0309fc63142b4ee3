#include "quadratic_cost.hpp"

#include <algorithm>
#include <atomic>

#include "hypotrack/gpu/device_cost.hpp"
#include "hypotrack/gpu/runtime.cuh"
#include "quadratic_kernel.hpp"

namespace hypotrack::test {
namespace {

/// Never the same twice, so that a graph cannot be mistaken for one of a cost at the same address.
std::uint64_t new_revision() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

}  // namespace

struct QuadraticCost::Device final : cuda::DeviceCost {
  explicit Device(Eigen::Index dimension)
      : target(static_cast<std::size_t>(dimension)),
        on_device(static_cast<std::size_t>(dimension)) {
    cudaStream_t made = nullptr;
    cuda::check(cudaStreamCreateWithFlags(&made, cudaStreamNonBlocking), "making a stream");
    handle.handle = made;
  }
  ~Device() override { cudaStreamDestroy(cuda::native(handle)); }

  cuda::Stream stream() const override { return handle; }
  void reserve(std::int64_t) override {}
  void enqueue(const double* points, std::int64_t count, double* costs) override {
    ++enqueued;
    enqueue_quadratic(broken ? nullptr : on_device.data(), static_cast<int>(target.size()), points,
                      count, costs, handle);
  }
  std::uint64_t revision() const override { return number; }

  void retarget(const Eigen::VectorXd& to) {
    std::ranges::copy(to, target.data());
    cuda::check(cudaMemcpyAsync(on_device.data(), target.data(), target.size() * sizeof(double),
                                cudaMemcpyHostToDevice, cuda::native(handle)),
                "copying a target");
  }

  cuda::Stream handle;
  cuda::PinnedBuffer<double> target;
  cuda::DeviceBuffer<double> on_device;
  std::uint64_t number = new_revision();
  int enqueued = 0;
  bool broken = false;
};

QuadraticCost::QuadraticCost(const Eigen::VectorXd& target)
    : device_(std::make_unique<Device>(target.size())) {
  retarget(target);
}
QuadraticCost::~QuadraticCost() = default;

int QuadraticCost::dimension() const { return static_cast<int>(device_->target.size()); }

void QuadraticCost::evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                             Eigen::Ref<Eigen::VectorXd> costs) {
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    double sum = 0;
    for (int d = 0; d < points.rows(); ++d) {
      const double offset = points(d, i) - device_->target.data()[d];
      sum += (d + 1) * (offset * offset);
    }
    costs[i] = sum;
  }
}

cuda::DeviceCost* QuadraticCost::device() { return device_.get(); }
void QuadraticCost::retarget(const Eigen::VectorXd& target) { device_->retarget(target); }
void QuadraticCost::revise() { device_->number = new_revision(); }
int QuadraticCost::enqueued() const { return device_->enqueued; }
void QuadraticCost::break_down() { device_->broken = true; }

}  // namespace hypotrack::test
