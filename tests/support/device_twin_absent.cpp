// Stands in for the twin in a build without a CUDA toolkit.
#include "device_twin.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::test {

struct DeviceTwin::Impl {};

DeviceTwin::DeviceTwin(CostFunction&) { throw DeviceError("built without CUDA"); }
DeviceTwin::~DeviceTwin() = default;
int DeviceTwin::dimension() const { return 0; }
void DeviceTwin::evaluate(const Eigen::Ref<const Eigen::MatrixXd>&, Eigen::Ref<Eigen::VectorXd>) {}
cuda::DeviceCost* DeviceTwin::device() { return nullptr; }
void DeviceTwin::on_enqueue(std::function<void()>) {}
void DeviceTwin::revise() {}

}  // namespace hypotrack::test
