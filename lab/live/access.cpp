#include "lab/live/access.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "hypotrack/api/error.hpp"

namespace hypotrack::internal {
namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

/// Returns the name in a Host header, without port and brackets, in small letters.
std::string name_in(std::string_view header) {
  if (header.starts_with('[')) return lower(header.substr(1, header.find(']') - 1));
  return lower(header.substr(0, header.find(':')));
}

bool is_address(const std::string& host) {
  std::array<unsigned char, sizeof(in6_addr)> parsed{};
  return inet_pton(AF_INET, host.c_str(), parsed.data()) == 1 ||
         inet_pton(AF_INET6, host.c_str(), parsed.data()) == 1;
}

/// Returns whether an Origin header names the host of a Host header. A proxy that adds TLS has
/// another scheme and port.
bool is_origin_of(std::string_view origin, std::string_view host) {
  constexpr std::string_view kSeparator = "://";
  const std::size_t scheme_end = origin.find(kSeparator);
  if (scheme_end == std::string_view::npos) return false;  // "null"
  return name_in(origin.substr(scheme_end + kSeparator.size())) == name_in(host);
}

/// Compares in a time that does not tell how far two texts agree.
bool equal_tokens(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  int difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference |= a[i] ^ b[i];
  return difference == 0;
}

}  // namespace

bool is_loopback(std::string_view host) {
  const std::string name = lower(host);
  return name == "localhost" || name == "::1" || (name.starts_with("127.") && is_address(name));
}

void check(const AccessRules& rules) {
  constexpr std::size_t kShortest = 8;
  if (rules.token.empty()) {
    if (is_loopback(rules.host)) return;
    throw ConfigError(
        fmt::format("--web-host {}: others could see and steer this run; give a secret word that "
                    "they need, --web-token-file FILE, or leave --web-host out",
                    rules.host));
  }
  const bool plain = std::ranges::all_of(rules.token, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.';
  });
  if (!plain || rules.token.size() < kShortest)
    throw ConfigError(fmt::format(
        "{}: expected {} or more letters, digits, '-', '_' and '.'; for example the output of "
        "`openssl rand -hex 16`",
        rules.token_source, kShortest));
}

std::string refusal(const AccessRules& rules, const Caller& caller) {
  const bool open = rules.token.empty();
  if (open && !is_loopback(name_in(caller.host)))
    return fmt::format(
        "'{}' is no name of this server; without a secret word it has localhost, 127.0.0.1 and ::1 "
        "only. To open it by other names start the run with --web-token-file FILE",
        caller.host);
  const bool own_page =
      caller.origin.empty() || (open ? lower(caller.origin) == "http://" + lower(caller.host)
                                     : is_origin_of(caller.origin, caller.host));
  if (!own_page)
    return fmt::format(
        "pages of {} may not use this server, which was asked for as '{}'; a proxy between has to "
        "pass the header Host on{}",
        caller.origin, caller.host,
        open ? ", and the run needs a secret word: --web-token-file FILE" : "");
  const bool foreign = !caller.fetch_site.empty() && caller.fetch_site != "same-origin" &&
                       caller.fetch_site != "none";
  if (foreign && !caller.navigates) return "pages of other servers may not use this one";
  if (!open && !equal_tokens(rules.token, caller.token))
    return "the token is missing or wrong; open the address that `hypotrack run` printed";
  return {};
}

}  // namespace hypotrack::internal
