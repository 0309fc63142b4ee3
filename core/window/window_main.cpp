// Shows one window for a program that asks for it over a socket: hypotrack_window TITLE WIDTH
// HEIGHT.
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "base/standard_streams.hpp"
#include "window/window.hpp"
#include "window/window_messages.hpp"

namespace hypotrack {
namespace {

/// Asks, and ends this process if the program is gone.
template <class Receive>
auto ask(const WindowQuestion& question, const Receive& receive) {
  if (send_question(kWindowSocket, question))
    if (auto answer = receive(kWindowSocket)) return *answer;
  std::_Exit(EXIT_SUCCESS);
}

WindowContent content_of(char** arguments) {
  WindowContent content;
  content.title = arguments[1];
  content.size = {std::atoi(arguments[2]), std::atoi(arguments[3])};
  content.picture = [](cv::Size area) {
    return ask({.kind = WindowQuestion::Kind::picture, .width = area.width, .height = area.height},
               receive_picture);
  };
  content.on_key = [](char key) {
    return ask({.kind = WindowQuestion::Kind::key, .key = key}, receive_step);
  };
  content.next = [] { return ask({.kind = WindowQuestion::Kind::next}, receive_step); };
  return content;
}

}  // namespace
}  // namespace hypotrack

int main(int count, char** arguments) {
  hypotrack::open_standard_streams();
  constexpr int kArguments = 4;
  if (count != kArguments) {
    std::fputs("usage: hypotrack_window TITLE WIDTH HEIGHT; hypotrack starts it\n", stderr);
    return EXIT_FAILURE;
  }
  try {
    hypotrack::load_window()(hypotrack::content_of(arguments));
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
