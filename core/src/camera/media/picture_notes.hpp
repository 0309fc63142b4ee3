#pragma once

#include <string>
#include <vector>

#include "camera/media/picture_converter.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

// Lines for the user on what is assumed about a video's pictures, and what is not honoured.

/// Returns the matrix of a picture's colours, of SWS_CS_: what it says, or what players assume.
int color_matrix_of(const AVFrame& frame);

std::string note_of_turn(Turn turn);
/// `degrees` is anticlockwise; NaN if the display matrix is singular.
std::string note_of_slant(double degrees);
void add_color_notes(const AVFrame& frame, std::vector<std::string>& notes);
void add_shape_notes(const Demuxer& video, const AVFrame& frame, std::vector<std::string>& notes);

}  // namespace internal
}  // namespace hypotrack
