#pragma once

#include <string>
#include <string_view>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Who may use the live view.
struct AccessRules {
  std::string host = "127.0.0.1";            ///< at which the server listens
  std::string token = {};                    ///< empty: none is needed
  std::string token_source = "--web-token";  ///< as messages name it
};

/// What a request says about its sender.
struct Caller {
  std::string host;        ///< header Host
  std::string origin;      ///< header Origin; empty: none
  std::string fetch_site;  ///< header Sec-Fetch-Site; empty: none
  bool navigates = false;  ///< opens a page, as a link does
  std::string token;
};

/// Returns whether a host is this machine's loopback: localhost, 127.x.x.x or ::1.
bool is_loopback(std::string_view host);

/// Throws ConfigError if a host other than loopback has no token, or if the token is short or has
/// characters that addresses would escape.
void check(const AccessRules& rules);

/// Returns why a request is refused; empty if it is allowed. Pages of other hosts may only link
/// here.
///
/// A foreign name can be made to lead here (DNS rebinding). Without a token, the header Host must
/// therefore be a name of loopback, and Origin the very same server. With a token any name is
/// served, as that of a container's host or a proxy: a page of a foreign name has not the token,
/// as browsers keep cookies by name. As they give them to all ports of a name, the ports of Host
/// and Origin are not compared.
std::string refusal(const AccessRules& rules, const Caller& caller);

}  // namespace internal
}  // namespace hypotrack
