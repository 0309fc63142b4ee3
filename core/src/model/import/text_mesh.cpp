#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/import/format.hpp"

namespace hypotrack::internal {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::string_view kSpaces = " \t\r\v\f";

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t begin = 0;;) {
    begin = line.find_first_not_of(kSpaces, begin);
    if (begin == line.npos) return words;
    const std::size_t end = std::min(line.find_first_of(kSpaces, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = end;
  }
}

template <class Number>
bool parse_whole(std::string_view word, Number& number) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const char* const end = word.data() + word.size();
  const auto [at, error] = std::from_chars(word.data(), end, number);
  return error == std::errc() && at == end;
}

/// Returns what is wrong with a list of at least `least` coordinates; empty if nothing is.
std::string problem_of_numbers(std::span<const std::string_view> words, std::size_t least) {
  if (words.size() < least)
    return fmt::format("has {} numbers, expected {}; the file may be cut off", words.size(), least);
  for (const std::string_view word : words) {
    double number = 0;
    if (!parse_whole(word, number) || !std::isfinite(number))
      return fmt::format("'{}' is no number: every coordinate must be finite", word);
  }
  return {};
}

/// The statements of an OBJ file that are not read, by their first word.
class UnreadStatements {
 public:
  void add(std::string_view word, int line) {
    constexpr std::size_t kMost = 50, kLongest = 20;
    const std::string name(word.substr(0, kLongest));
    const auto known = all_.find(name);
    if (known != all_.end()) {
      ++known->second.count;
    } else if (all_.size() < kMost) {
      all_[name] = {1, line};
    } else {
      ++further_;
    }
  }

  void tell(std::vector<std::string>& notes) const {
    if (all_.empty()) return;
    std::vector<std::string> texts;
    for (const auto& [name, seen] : all_) {
      const std::string what = meaning(name);
      texts.push_back(fmt::format("{} `{}` from line {}{}", seen.count, name, seen.first,
                                  what.empty() ? "" : " (" + what + ")"));
    }
    if (further_ > 0) texts.push_back(fmt::format("{} others", further_));
    notes.push_back(fmt::format("statements that are not read: {}", fmt::join(texts, ", ")));
  }

 private:
  struct Seen {
    int count = 0, first = 0;
  };

  static std::string meaning(std::string_view name) {
    constexpr std::array<std::string_view, 16> kFreeForm = {
        "vp",   "cstype", "deg",  "bmat", "step", "curv", "curv2", "surf",
        "parm", "trim",   "hole", "scrv", "sp",   "end",  "con",   "ctech"};
    if (name == "l") return "lines";
    if (name == "p") return "points";
    if (std::ranges::find(kFreeForm, name) != kFreeForm.end())
      return "curves and surfaces: export triangles";
    return {};
  }

  std::map<std::string, Seen, std::less<>> all_;
  int further_ = 0;
};

/// Returns whether a statement of an OBJ file is read, or says nothing about the surface.
bool is_read(std::string_view word) {
  constexpr std::array<std::string_view, 10> kRead = {"v", "vt", "vn", "f",      "fo",
                                                      "g", "o",  "s",  "usemtl", "mtllib"};
  return std::ranges::find(kRead, word) != kRead.end();
}

/// Reads the lines of an OBJ file.
class ObjReader {
 public:
  std::string problem_of_line(const std::vector<std::string_view>& words) {
    constexpr std::array<std::pair<std::string_view, std::size_t>, kElements> kLeast = {
        {{"v", 3}, {"vt", 1}, {"vn", 3}}};
    if (words.empty()) return {};
    if (!is_read(words[0])) {
      // The importer takes `lod` for `l` and `parm` for `p`.
      if (words[0].size() > 1 && (words[0][0] == 'l' || words[0][0] == 'p'))
        return fmt::format("`{}` is not read: delete the line, or export triangles", words[0]);
      unread_.add(words[0], line);
    }
    if (words[0] == "usemtl") has_material_ = true;
    if (words[0] == "f") {
      faces_before_ += has_material_ ? 0 : 1;
      return problem_of_face(words);
    }
    for (std::size_t e = 0; e < kElements; ++e) {
      if (words[0] != kLeast[e].first) continue;
      ++counts_[e];
      for (const std::string_view word : std::span(words).subspan(1)) {
        if (word.starts_with('.'))  // assimp leaves out vertices of such numbers
          return fmt::format("{} '{}' has no digit before the dot; write 0{}", words[0], word,
                             word);
      }
      const std::string problem = problem_of_numbers(std::span(words).subspan(1), kLeast[e].second);
      return problem.empty() ? problem : fmt::format("{} {}", words[0], problem);
    }
    return {};
  }

  /// Returns what is wrong with the indices, which may name later lines; empty if nothing is.
  std::string problem_at_end() const {
    for (std::size_t e = 0; e < kElements; ++e) {
      if (largest_[e].index > counts_[e])
        return fmt::format(
            "line {}: the face names {} {}, but there are {}; the file may be cut off",
            largest_[e].line, kNames[e], largest_[e].index, counts_[e]);
    }
    return {};
  }

  void tell(std::vector<std::string>& notes) const {
    unread_.tell(notes);
    if (has_material_ && faces_before_ > 0)
      notes.push_back(
          fmt::format("faces before the first `usemtl` ({}) have no material of their own: they "
                      "may be drawn with the first one; put `usemtl` before them",
                      faces_before_));
  }

  int line = 0;

 private:
  static constexpr std::size_t kElements = 3;  // of a corner: v/vt/vn
  static constexpr std::array<const char*, kElements> kNames = {"vertex", "texture coordinate",
                                                                "normal"};
  struct Named {
    std::int64_t index = 0;
    int line = 0;
  };

  std::string problem_of_face(const std::vector<std::string_view>& words) {
    if (words.size() < 4)
      return fmt::format(
          "the face has {} corners, expected three at least; the file may be cut off",
          words.size() - 1);
    for (const std::string_view corner : std::span(words).subspan(1)) {
      std::string_view rest = corner;
      for (std::size_t e = 0; e < kElements; ++e) {
        const std::size_t end = std::min(rest.find('/'), rest.size());
        const std::string_view word = rest.substr(0, end);
        const bool last = end == rest.size();
        if (!(word.empty() && e == 1 && !last) && !take_index(word, e))
          return fmt::format("the face's corner '{}' names no {}", corner, kNames[e]);
        if (last) break;
        if (e + 1 == kElements) return fmt::format("the face's corner '{}' has too many /", corner);
        rest.remove_prefix(end + 1);
      }
    }
    return {};
  }

  bool take_index(std::string_view word, std::size_t element) {
    std::int64_t index = 0;
    if (!parse_whole(word, index) || index == 0 || index < -counts_[element]) return false;
    if (index > largest_[element].index) largest_[element] = {index, line};
    return true;
  }

  std::array<std::int64_t, kElements> counts_{};
  std::array<Named, kElements> largest_{};
  UnreadStatements unread_;
  bool has_material_ = false;
  std::int64_t faces_before_ = 0;  ///< the first material
};

}  // namespace

std::string problem_of_obj(std::istream& in, std::vector<std::string>& notes) {
  ObjReader reader;
  std::string text;
  for (std::string line; std::getline(in, line);) {
    ++reader.line;
    if (line.ends_with('\r')) line.pop_back();
    const bool marked = reader.line == 1 && line.starts_with(kByteOrderMark);
    if (marked) line.erase(0, kByteOrderMark.size());
    text += line.substr(0, line.find('#'));
    if (const std::vector<std::string_view> words = words_of(text);
        marked && !words.empty() && words[0] != "mtllib")
      return fmt::format("line 1: a byte order mark hides its `{}`; save the file without the mark",
                         words[0]);
    if (text.ends_with('\\')) {  // goes on in the next line
      text.back() = ' ';
      continue;
    }
    const std::string problem = reader.problem_of_line(words_of(text));
    if (!problem.empty()) return fmt::format("line {}: {}", reader.line, problem);
    text.clear();
  }
  reader.tell(notes);
  return reader.problem_at_end();
}

std::string problem_of_text_stl(std::istream& in, std::vector<std::string>& /*notes*/) {
  // The lines of a facet; `solid` and `endsolid` stand around any number of them.
  constexpr std::array<std::string_view, 7> kFacet = {"facet",  "outer",   "vertex",  "vertex",
                                                      "vertex", "endloop", "endfacet"};
  bool in_solid = false;
  std::size_t next = 0;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    const auto words = words_of(line);
    if (words.empty()) continue;
    if (next == 0 && words[0] == (in_solid ? "endsolid" : "solid")) {
      in_solid = !in_solid;
      continue;
    }
    if (!in_solid || words[0] != kFacet[next])
      return fmt::format("line {}: begins with '{}', expected '{}'", number, words[0],
                         in_solid ? kFacet[next] : "solid");
    if (words[0] == "vertex") {
      const std::string problem = problem_of_numbers(std::span(words).subspan(1), 3);
      if (!problem.empty()) return fmt::format("line {}: vertex {}", number, problem);
    }
    next = (next + 1) % kFacet.size();
  }
  if (!in_solid) return {};
  return fmt::format("line {}: ends without 'endsolid'; the file is cut off", number);
}

}  // namespace hypotrack::internal
