#pragma once

#include <optional>
#include <string>

#include "calibrate/board/board.hpp"
#include "command_line.hpp"

namespace hypotrack::app {

/// A board as the command line describes it.
struct BoardOptions {
  std::string board, square, dictionary = "4X4_50", pattern = "auto";
  std::optional<std::string> marker;
  bool inverted = false;
};

void add_board_options(const Command& command, BoardOptions& options, bool required);

/// Returns the board. Throws ConfigError for texts that say none.
calibrate::Board board_of(const BoardOptions& options);

/// Returns the options as they are given on a command line.
std::string words_of(const BoardOptions& options);

}  // namespace hypotrack::app
