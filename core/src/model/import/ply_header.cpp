#include "model/import/ply_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <istream>
#include <iterator>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

namespace hypotrack::internal {
namespace {

constexpr int kMostLines = 1000;
constexpr std::uint64_t kMostElements = std::uint64_t{1} << 32;
constexpr std::uint64_t kCorners = 3;  // least number per face

using Words = std::vector<std::string>;

Words header_words(const std::string& line) {
  std::istringstream in(line);
  return {std::istream_iterator<std::string>(in), {}};
}

/// Returns the bytes of a PLY number type; 0 for an unknown type.
std::uint64_t size_of(std::string_view type) {
  constexpr std::array<std::pair<std::string_view, std::uint64_t>, 16> kSizes = {{{"char", 1},
                                                                                  {"uchar", 1},
                                                                                  {"short", 2},
                                                                                  {"ushort", 2},
                                                                                  {"int", 4},
                                                                                  {"uint", 4},
                                                                                  {"float", 4},
                                                                                  {"double", 8},
                                                                                  {"int8", 1},
                                                                                  {"uint8", 1},
                                                                                  {"int16", 2},
                                                                                  {"uint16", 2},
                                                                                  {"int32", 4},
                                                                                  {"uint32", 4},
                                                                                  {"float32", 4},
                                                                                  {"float64", 8}}};
  const auto* found = std::ranges::find(kSizes, type, &decltype(kSizes)::value_type::first);
  return found == kSizes.end() ? 0 : found->second;
}

/// Returns whether the importer reads an element.
bool reads_element(std::string_view name) {
  constexpr std::array<std::string_view, 4> kRead = {"vertex", "face", "tristrips", "material"};
  return std::ranges::find(kRead, name) != kRead.end();
}

/// Returns whether the importer reads a property, or it says nothing about the surface.
bool reads_property(std::string_view element, std::string_view name) {
  constexpr std::array<std::string_view, 20> kOfVertices = {
      "x", "y", "z", "nx",    "ny", "nz", "red", "green", "blue",      "r",
      "g", "b", "a", "alpha", "s",  "t",  "u",   "v",     "texture_u", "texture_v"};
  constexpr std::array<std::string_view, 3> kOfFaces = {"vertex_indices", "vertex_index",
                                                        "texcoord"};
  if (element == "vertex") return std::ranges::find(kOfVertices, name) != kOfVertices.end();
  if (element == "face") return std::ranges::find(kOfFaces, name) != kOfFaces.end();
  return true;
}

class Header {
 public:
  /// Returns true if there is more to read.
  bool take(const std::string& line) {
    const Words words = header_words(line);
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") return true;
    if (words[0] == "end_header") return finish();
    const bool understood = words[0] == "format"     ? take_format(words)
                            : words[0] == "element"  ? take_element(words)
                            : words[0] == "property" ? take_property(words)
                                                     : false;
    if (!understood) out_.problem = fmt::format("its header has the line '{}'", line.substr(0, 80));
    return understood;
  }
  PlyHeader result() && { return std::move(out_); }

 private:
  bool take_format(const Words& words) {
    if (words.size() != 3 || words[2] != "1.0") return false;
    out_.is_text = words[1] == "ascii";
    known_format_ = out_.is_text || words[1].starts_with("binary_");
    return known_format_;
  }
  bool take_element(const Words& words) {
    add_element();
    if (words.size() != 3) return false;
    name_ = words[1];
    bytes_ = 0;
    if (!reads_element(name_)) add_unread(name_);
    std::istringstream in(words[2]);
    if (name_ == "tristrips") out_.has_strips = true;
    return in >> count_ && in.eof() && words[2][0] != '-' && count_ < kMostElements;
  }
  bool take_property(const Words& words) {
    const bool list = words.size() == 5 && words[1] == "list";
    if (name_.empty() || (!list && words.size() != 3)) return false;
    if (!reads_property(name_, words.back())) add_unread(name_ + " " + words.back());
    if (!list) {
      bytes_ += size_of(words[1]);
      return size_of(words[1]) > 0;
    }
    const std::uint64_t length = size_of(words[2]), item = size_of(words[3]);
    bytes_ += length + (words[4].starts_with("vertex_ind") ? kCorners * item : 0);
    return length > 0 && item > 0;
  }
  void add_unread(const std::string& name) {
    constexpr std::size_t kMost = 20, kLongest = 60;
    if (++unread_ <= kMost)
      out_.unread += (unread_ == 1 ? "" : ", ") + name.substr(0, kLongest);
    else if (unread_ == kMost + 1)
      out_.unread += " and others";
  }
  bool finish() {
    add_element();
    if (!known_format_) out_.problem = "its header has no line 'format'";
    return false;
  }
  void add_element() {
    if (name_.empty()) return;
    out_.elements += fmt::format("{}{} {}", out_.elements.empty() ? "" : ", ", count_, name_);
    out_.count += count_;
    out_.least += count_ * bytes_;
    name_.clear();
  }

  PlyHeader out_;
  bool known_format_ = false;
  std::string name_;  ///< element of the following properties
  std::uint64_t count_ = 0, bytes_ = 0;
  std::size_t unread_ = 0;
};

}  // namespace

PlyHeader read_ply_header(std::istream& in) {
  PlyHeader out;
  std::string line;
  const auto next = [&] { return static_cast<bool>(std::getline(in, line)); };
  if (!next() || header_words(line) != Words{"ply"}) {
    out.problem = "it does not begin with 'ply'";
    return out;
  }
  Header header;
  for (int i = 0; i < kMostLines; ++i) {
    if (!next()) break;
    if (!header.take(line)) return std::move(header).result();
  }
  out.problem = "its header does not end";
  return out;
}

}  // namespace hypotrack::internal
