#pragma once

#include <stdexcept>
#include <string>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// Base of everything hypotrack throws on purpose. The message is complete: where, what was found,
/// what was expected, what to do. The program prints it as it is and exits non-zero.
class HYPOTRACK_API Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message);
  Error(const Error&) = default;
  Error& operator=(const Error&) = default;
  ~Error() override;
};

/// A scene, a parameter or a command line that cannot be used.
class HYPOTRACK_API ConfigError : public Error {
 public:
  using Error::Error;
  ~ConfigError() override;
};

/// An image, video, mesh, rig, calibration or table that cannot be used.
class HYPOTRACK_API DataError : public Error {
 public:
  using Error::Error;
  ~DataError() override;
};

/// A plugin that is missing, does not fit this build, or breaks its contract.
class HYPOTRACK_API PluginError : public Error {
 public:
  using Error::Error;
  ~PluginError() override;
};

/// A GPU or an OpenGL context that is missing or failed.
class HYPOTRACK_API DeviceError : public Error {
 public:
  using Error::Error;
  ~DeviceError() override;
};

/// A result that cannot be written.
class HYPOTRACK_API OutputError : public Error {
 public:
  using Error::Error;
  ~OutputError() override;
};

}  // namespace hypotrack
