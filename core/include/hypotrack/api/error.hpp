#pragma once

#include <stdexcept>
#include <string>

#include "hypotrack/api/export.hpp"

namespace hypotrack {

/// Base of all exceptions that hypotrack throws. The message is complete: where, what was found,
/// what was expected, what to do. The program prints it and exits non-zero.
class HYPOTRACK_API Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message);
  Error(const Error&) = default;
  Error& operator=(const Error&) = default;
  ~Error() override;
};

/// An invalid scene, parameter or command line.
class HYPOTRACK_API ConfigError : public Error {
 public:
  using Error::Error;
  ~ConfigError() override;
};

/// An unusable image, video, mesh, rig, calibration or table.
class HYPOTRACK_API DataError : public Error {
 public:
  using Error::Error;
  ~DataError() override;
};

/// A plugin that is missing, does not fit this build or breaks its contract.
class HYPOTRACK_API PluginError : public Error {
 public:
  using Error::Error;
  ~PluginError() override;
};

/// A missing or failed GPU or OpenGL context.
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
