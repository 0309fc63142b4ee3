#pragma once

#include <functional>
#include <string>

namespace hypotrack::app {

/// A value of a scene that may be given by an option or asked for.
struct Question {
  std::string option;      ///< for messages: --model
  std::string text;        ///< asked on a terminal
  std::string usual = {};  ///< taken for an empty answer; empty: an answer is needed
};

/// Asks on the terminal until `take` accepts the answer; it throws Error with what is wrong with
/// one. Throws ConfigError, naming the option, if standard input is no terminal or ends.
void ask(const Question& question, const std::function<void(const std::string&)>& take);

}  // namespace hypotrack::app
