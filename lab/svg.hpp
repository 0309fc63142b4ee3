#pragma once

#include <string>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

// Elements of SVG pictures, each a line of text.

/// Returns a line; `style` has its attributes.
std::string svg_line(double x1, double y1, double x2, double y2, const std::string& style);

/// Returns a text that is SVG already; `attributes` has the others.
std::string svg_text(double x, double y, const std::string& text,
                     const std::string& attributes = R"(text-anchor="middle")");

/// Replaces the characters that SVG would read as its own.
std::string svg_escaped(const std::string& text);

}  // namespace internal
}  // namespace hypotrack
