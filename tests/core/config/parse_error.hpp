#pragma once

#include <string>
#include <string_view>

#include "expect_error.hpp"
#include "hypotrack/api/config.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::test {

/// Returns the message with which a file of this text is refused.
inline std::string parse_error(std::string_view text) {
  return message_of<ConfigError>([&] { ConfigNode::parse(text, "scene.yaml"); });
}

}  // namespace hypotrack::test
