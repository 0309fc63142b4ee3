#include "boards/board_options.hpp"

#include <fmt/format.h>

#include <vector>

#include "hypotrack/api/error.hpp"

namespace hypotrack::app {
namespace {

const std::vector<std::string> kPatterns = {"auto", "black", "marker"};

}  // namespace

void add_board_options(const Command& command, BoardOptions& options, bool required) {
  command.add("--board", &options.board,
              "Inner corners of a chessboard (9x6) or squares of a ChArUco board (charuco:5x7)",
              {.required = required, .value_name = "9x6"});
  command.add("--square", &options.square, "Side of a square, with its unit",
              {.required = required, .value_name = "25mm"});
  command.add("--marker", &options.marker, "Side of a marker (default: 0.75 of a square)",
              {.value_name = "18mm"});
  command.add("--dictionary", &options.dictionary, "Markers of a ChArUco board",
              {.show_default = true, .check = one_of(calibrate::dictionary_names())});
  command.add("--pattern", &options.pattern,
              "Top left square of a ChArUco board: black, marker (even rows of OpenCV before 4.6, "
              "its legacy pattern), or auto: as in the pictures",
              {.show_default = true, .check = one_of(kPatterns)});
  command.add("--inverted", &options.inverted, "White and black of the board are exchanged");
}

calibrate::Board board_of(const BoardOptions& options) {
  calibrate::Board out = calibrate::parse_board(options.board, options.square);
  out.dictionary = options.dictionary;
  out.inverted = options.inverted;
  if (options.pattern != kPatterns[0]) out.marker_first = options.pattern == kPatterns[2];
  if (options.marker) out.marker = calibrate::parse_length(*options.marker, "--marker");
  if (out.marker >= out.square) {
    throw ConfigError(fmt::format("--marker is {}; expected less than --square, {}",
                                  *options.marker, options.square));
  }
  return out;
}

std::string words_of(const BoardOptions& options) {
  std::string out = fmt::format("--board {} --square {}", options.board, options.square);
  if (options.board.starts_with("charuco")) out += " --dictionary " + options.dictionary;
  if (options.marker) out += " --marker " + *options.marker;
  if (options.inverted) out += " --inverted";
  if (options.pattern != kPatterns[0]) out += " --pattern " + options.pattern;
  return out;
}

}  // namespace hypotrack::app
