#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "base/exported.hpp"
#include "cost/linearize/host_linearizer.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Linearizers of one scene, as many as are used at the same time.
class LinearizerPool {
 public:
  /// `make` makes one; it is called from several threads, one at a time.
  explicit LinearizerPool(std::function<std::unique_ptr<HostLinearizer>()> make)
      : make_(std::move(make)) {}

  /// Sets the frame, which must outlive every use().
  void prepare(const Observation& observation);

  /// Calls work(linearizer) with a prepared one that nobody else uses. Called from several threads.
  void use(const std::function<void(HostLinearizer&)>& work);

 private:
  struct Entry {
    std::unique_ptr<HostLinearizer> linearizer;
    bool is_prepared = false;
  };
  Entry take();

  std::function<std::unique_ptr<HostLinearizer>()> make_;
  const Observation* observation_ = nullptr;
  std::mutex mutex_;
  std::vector<Entry> free_;
};

}  // namespace internal
}  // namespace hypotrack
