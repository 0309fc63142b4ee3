// Out-of-line destructors anchor type information in libhypotrack.so, so that plugins' exceptions
// are caught.
#include "hypotrack/api/error.hpp"

namespace hypotrack {

Error::Error(const std::string& message) : std::runtime_error(message) {}
Error::~Error() = default;
ConfigError::~ConfigError() = default;
DataError::~DataError() = default;
PluginError::~PluginError() = default;
DeviceError::~DeviceError() = default;
OutputError::~OutputError() = default;

}  // namespace hypotrack
