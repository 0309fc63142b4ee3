#include "lab/live/access.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "hypotrack/error.hpp"

namespace hypotrack::internal {
namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

/// Returns the name in a Host header, without port and brackets.
std::string name_in(std::string_view header) {
  if (header.starts_with('[')) return lower(header.substr(1, header.find(']') - 1));
  return lower(header.substr(0, header.find(':')));
}

bool is_address(const std::string& host) {
  std::array<unsigned char, sizeof(in6_addr)> parsed{};
  return inet_pton(AF_INET, host.c_str(), parsed.data()) == 1 ||
         inet_pton(AF_INET6, host.c_str(), parsed.data()) == 1;
}

bool is_own_name(const std::string& host) {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return host == lower(name.data());
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
  const std::string host = name_in(caller.host);
  const bool known = is_loopback(rules.host) ? is_loopback(host)
                                             : is_address(host) || host == "localhost" ||
                                                   host == lower(rules.host) || is_own_name(host);
  if (!known) return fmt::format("'{}' is no name of this server", caller.host);
  if (!caller.origin.empty() && lower(caller.origin) != "http://" + lower(caller.host))
    return fmt::format("pages of {} may not use this server", caller.origin);
  const bool foreign = !caller.fetch_site.empty() && caller.fetch_site != "same-origin" &&
                       caller.fetch_site != "none";
  if (foreign && !caller.navigates) return "pages of other servers may not use this one";
  if (!rules.token.empty() && !equal_tokens(rules.token, caller.token))
    return "the token is missing or wrong; open the address that `hypotrack run` printed";
  return {};
}

}  // namespace hypotrack::internal
