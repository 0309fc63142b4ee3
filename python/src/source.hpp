#pragma once

#include <atomic>
#include <memory>

#include "common.hpp"
#include "hypotrack/plugin/source.hpp"

namespace hypotrack::python {

/// The source of a scene, owned by Python.
class PythonSceneSource {
 public:
  explicit PythonSceneSource(std::unique_ptr<Source> source) : source_(std::move(source)) {}
  ~PythonSceneSource() { end_without_gil(source_); }
  PythonSceneSource(const PythonSceneSource&) = delete;
  PythonSceneSource& operator=(const PythonSceneSource&) = delete;

  /// Returns the next frame. Throws StopIteration at the end.
  Frame next() {
    const Busy busy(busy_, "source");
    std::optional<Frame> frame = without_gil([&] { return source_->next(); });
    if (!frame) throw py::stop_iteration();
    return *std::move(frame);
  }
  const Source& source() const { return *source_; }

 private:
  std::unique_ptr<Source> source_;
  std::atomic<bool> busy_ = false;
};

}  // namespace hypotrack::python
