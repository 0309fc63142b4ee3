#include "device_twin.hpp"

#include <atomic>
#include <deque>
#include <utility>

#include "hypotrack/gpu/runtime.cuh"

namespace hypotrack::test {
namespace {

using cuda::check;
using cuda::native;

/// Returns a unique revision, so that a graph is not taken for one of a twin at the same address.
std::uint64_t new_revision() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

}  // namespace

struct DeviceTwin::Impl final : cuda::DeviceCost {
  /// A batch that a stream, or a graph, evaluates.
  struct Batch {
    Impl* twin;
    Eigen::Index count;
  };

  explicit Impl(CostFunction& cost) : host(cost) {
    cudaStream_t made = nullptr;
    check(cudaStreamCreateWithFlags(&made, cudaStreamNonBlocking), "making a stream");
    handle.handle = made;
  }
  ~Impl() override {
    cudaStreamSynchronize(native(handle));
    cudaStreamDestroy(native(handle));
  }

  cuda::Stream stream() const override { return handle; }
  std::uint64_t revision() const override { return number; }
  void reserve(std::int64_t count) override {
    points.reserve(static_cast<std::size_t>(count * host.dimension()));
    costs.reserve(static_cast<std::size_t>(count));
  }
  void enqueue(const double* from, std::int64_t count, double* to) override {
    if (hook) hook();
    const auto bytes = static_cast<std::size_t>(count) * sizeof(double);
    check(cudaMemcpyAsync(points.data(), from, bytes * static_cast<std::size_t>(host.dimension()),
                          cudaMemcpyDeviceToHost, native(handle)),
          "copying points");
    check(cudaLaunchHostFunc(native(handle), evaluate, &batches.emplace_back(this, count)),
          "enqueuing a function of the host");
    check(cudaMemcpyAsync(to, costs.data(), bytes, cudaMemcpyHostToDevice, native(handle)),
          "copying costs");
  }
  static void evaluate(void* batch) {
    const auto& [twin, count] = *static_cast<Batch*>(batch);
    Eigen::Map<Eigen::VectorXd> results(twin->costs.data(), count);
    twin->host.evaluate(
        Eigen::Map<const Eigen::MatrixXd>(twin->points.data(), twin->host.dimension(), count),
        results);
  }

  CostFunction& host;
  cuda::Stream handle;
  std::uint64_t number = new_revision();
  cuda::PinnedBuffer<double> points, costs;
  std::deque<Batch> batches;  ///< a deque, as graphs point to its elements
  std::function<void()> hook;
};

DeviceTwin::DeviceTwin(CostFunction& host) : impl_(std::make_unique<Impl>(host)) {}
DeviceTwin::~DeviceTwin() = default;
int DeviceTwin::dimension() const { return impl_->host.dimension(); }
void DeviceTwin::evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                          Eigen::Ref<Eigen::VectorXd> costs) {
  impl_->host.evaluate(points, costs);
}
cuda::DeviceCost* DeviceTwin::device() { return impl_.get(); }
void DeviceTwin::on_enqueue(std::function<void()> hook) { impl_->hook = std::move(hook); }
void DeviceTwin::revise() { impl_->number = new_revision(); }

}  // namespace hypotrack::test
