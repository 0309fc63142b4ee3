#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace hypotrack::app {

/// Where the secret word of a run's page may be given.
struct WebTokenSources {
  std::optional<std::string> word = {};            ///< --web-token
  std::optional<std::filesystem::path> file = {};  ///< --web-token-file
  std::optional<std::string> variable = {};        ///< HYPOTRACK_WEB_TOKEN
};

struct WebToken {
  std::string word;    ///< empty: none is given
  std::string source;  ///< as messages name it: `--web-token`
};

/// Returns the variable HYPOTRACK_WEB_TOKEN and takes it out of the environment, so that the
/// programs that this one starts do not get it.
std::optional<std::string> take_web_token_variable();

/// Returns the word of the one source that is given. Says to `note` if others may read its file.
/// Throws ConfigError if several are given, if the file cannot be read, or if the word is empty.
WebToken read_web_token(const WebTokenSources& sources,
                        const std::function<void(const std::string&)>& note);

}  // namespace hypotrack::app
