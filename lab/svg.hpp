#pragma once

#include <fmt/format.h>

#include <string>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

// Elements of SVG pictures, each a line of text.

/// Returns a line; `style` has its attributes.
inline std::string svg_line(double x1, double y1, double x2, double y2, const std::string& style) {
  return fmt::format(R"(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" {}/>)"
                     "\n",
                     x1, y1, x2, y2, style);
}

/// Returns a text that is SVG already; `attributes` has the others.
inline std::string svg_text(double x, double y, const std::string& text,
                            const std::string& attributes = R"(text-anchor="middle")") {
  return fmt::format(R"(<text x="{:.1f}" y="{:.1f}" {}>{}</text>)"
                     "\n",
                     x, y, attributes, text);
}

/// Replaces the characters that SVG would read as its own.
inline std::string svg_escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<')
      out += "&lt;";
    else if (c == '&')
      out += "&amp;";
    else
      out += c;
  }
  return out;
}

}  // namespace internal
}  // namespace hypotrack
