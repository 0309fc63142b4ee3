#include <fmt/format.h>
#include <unistd.h>

#include <iostream>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/text.hpp"
#include "messages.hpp"
#include "new_scene/scene_request.hpp"

namespace hypotrack::app {

void ask(const Question& question, const std::function<void(const std::string&)>& take) {
  if (isatty(STDIN_FILENO) != 1)
    throw ConfigError(
        fmt::format("{} is not given, and standard input is no terminal to ask on; expected {}",
                    question.option, question.text));
  for (;;) {
    tell("{}{}: ", question.text,
         question.usual.empty() ? "" : fmt::format(" [{}]", question.usual));
    std::string line;
    if (!std::getline(std::cin, line))
      throw ConfigError(fmt::format("{} is not given, and the answers have ended; expected {}",
                                    question.option, question.text));
    std::string answer(trimmed(line));
    if (answer.empty()) answer = question.usual;
    if (answer.empty()) continue;
    try {
      return take(answer);
    } catch (const Error& e) {
      tell("{}\n", e.what());
    }
  }
}

}  // namespace hypotrack::app
