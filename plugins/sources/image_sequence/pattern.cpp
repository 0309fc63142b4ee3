#include "pattern.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <limits>
#include <set>

#include "hypotrack/api/error.hpp"

namespace hypotrack {
namespace {

namespace fs = std::filesystem;

constexpr int kLargestCount = 10'000'000;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The parts of a path with one %d in it. The text never reaches printf.
struct Numbered {
  std::string before;  ///< up to the number
  std::string after;
  int width = 0;
  char fill = ' ';

  std::string with(int number) const {
    std::string digits = std::to_string(number);
    const auto size = static_cast<int>(digits.size());
    if (size < width) digits.insert(0, static_cast<std::size_t>(width - size), fill);
    return before + digits + after;
  }
};

std::string unescape(std::string text) {
  for (std::size_t at = text.find("%%"); at != std::string::npos; at = text.find("%%", at + 1)) {
    text.erase(at, 1);
  }
  return text;
}

std::optional<Numbered> parse_numbered(const std::string& pattern) {
  std::optional<Numbered> found;
  for (std::size_t at = pattern.find('%'); at != std::string::npos;) {
    if (pattern.compare(at, 2, "%%") == 0) {
      at = pattern.find('%', at + 2);
      continue;
    }
    std::size_t end = at + 1;
    while (end < pattern.size() && is_digit(pattern[end])) ++end;
    const std::string width = pattern.substr(at + 1, end - at - 1);
    const bool conversion = end < pattern.size() && (pattern[end] == 'd' || pattern[end] == 'i');
    if (!conversion || width.size() > 2 || found) {
      throw DataError(
          fmt::format("{}: the pattern is not understood; expected one number such as "
                      "%d or %04d (and %% for a percent sign)",
                      pattern));
    }
    found = Numbered{unescape(pattern.substr(0, at)), unescape(pattern.substr(end + 1)),
                     width.empty() ? 0 : std::stoi(width), width.starts_with('0') ? '0' : ' '};
    at = pattern.find('%', end);
  }
  return found;
}

/// Returns the numbers for which a file exists.
std::set<int> existing_numbers(const Numbered& numbered) {
  const std::size_t slash = numbered.before.rfind('/');
  const std::string folder =
      slash == std::string::npos ? "." : numbered.before.substr(0, slash + 1);
  const std::string prefix =
      slash == std::string::npos ? numbered.before : numbered.before.substr(slash + 1);
  std::set<int> numbers;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (!name.starts_with(prefix)) continue;
    std::size_t first = prefix.size();
    while (first < name.size() && name[first] == ' ') ++first;
    int number = 0;
    const auto [stop, failure] =
        std::from_chars(name.data() + first, name.data() + name.size(), number);
    if (failure != std::errc{} || number < 0) continue;
    const fs::path whole = numbered.with(number);
    const bool same_name = whole.string().starts_with((fs::path(folder) / name).string()) ||
                           whole.string().starts_with(name);
    if (same_name && fs::is_regular_file(whole, error)) numbers.insert(number);
    error.clear();
  }
  return numbers;
}

/// Returns whether a name matches a pattern: `*` is any text, `?` any character.
bool matches(std::string_view pattern, std::string_view name) {
  std::size_t p = 0, n = 0, star = std::string_view::npos, resume = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      resume = n;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == name[n])) {
      ++p;
      ++n;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      n = ++resume;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

/// Returns advice if files match a numbered pattern but for the form of the number.
std::string other_numbers(const std::vector<Numbered>& views) {
  for (const Numbered& view : views) {
    const ImageList files = glob(view.before + "*" + view.after);
    if (files.empty()) continue;
    return fmt::format(
        "\n{} is there, but what it has in place of the number is none from 0 to {} as the pattern "
        "writes it; with * instead of the number, files are taken in the order of their names",
        files.front().filename().string(), std::numeric_limits<int>::max());
  }
  return {};
}

/// Throws DataError if a pattern of pictures also finds the masks or depth images beside them.
void refuse_other_kinds(const fs::path& pattern, const ImageList& files) {
  for (const char* kind : {"mask", "depth"}) {
    const auto is_kind = [&](const fs::path& file) {
      return file.filename().string().find(kind) != std::string::npos;
    };
    const auto other = std::ranges::find_if(files, is_kind);
    const auto picture = std::ranges::find_if_not(files, is_kind);
    if (other == files.end() || picture == files.end()) continue;
    throw DataError(
        fmt::format("{} finds {} and {}; expected images of one kind. Use a number instead of * "
                    "(%06d), or more "
                    "of the name",
                    pattern.string(), picture->filename().string(), other->filename().string()));
  }
}

Images numbered_lists(const std::vector<fs::path>& patterns, const std::vector<Numbered>& views,
                      const Selection& selection) {
  std::set<int> numbers;
  for (const Numbered& view : views) numbers.merge(existing_numbers(view));
  if (numbers.empty()) nothing_found(patterns, other_numbers(views));
  const int start = selection.start.value_or(*numbers.begin());
  const auto span = std::int64_t{*numbers.rbegin()} - start;
  const std::int64_t found = span < 0 ? 0 : span / selection.step + 1;
  const std::int64_t count =
      selection.count.value_or(static_cast<int>(std::min<std::int64_t>(found, kLargestCount + 1)));
  if (count < 1) {
    throw DataError(
        fmt::format("{}: the last image has number {}; expected one from `start: {}` on",
                    patterns[0].string(), *numbers.rbegin(), start));
  }
  if (!selection.count && count > 100 + 20 * static_cast<std::int64_t>(numbers.size())) {
    throw DataError(fmt::format(
        "{}: {} images are numbered from {} to {}: most frames would be missing. Give `step` or "
        "`count`, or use * instead of a number",
        patterns[0].string(), numbers.size(), *numbers.begin(), *numbers.rbegin()));
  }
  std::vector<ImageList> lists(views.size());
  for (std::size_t v = 0; v < views.size(); ++v) {
    for (std::int64_t i = 0; i < count; ++i) {
      const std::int64_t number = start + i * selection.step;
      if (number > std::numeric_limits<int>::max()) break;
      lists[v].emplace_back(views[v].with(static_cast<int>(number)));
    }
  }
  return {std::move(lists), start, *numbers.begin(), *numbers.rbegin()};
}

Images listed(const std::vector<fs::path>& patterns, const Selection& selection) {
  std::vector<ImageList> lists;
  for (const fs::path& pattern : patterns) {
    const bool wild = pattern.filename().string().find_first_of("*?") != std::string::npos;
    const fs::path plain = unescape(pattern.string());
    std::error_code error;
    if (wild) {
      lists.push_back(glob(plain));
      refuse_other_kinds(pattern, lists.back());
    } else {
      lists.push_back(fs::is_regular_file(plain, error) ? ImageList{plain} : ImageList{});
    }
  }
  const bool all_empty =
      std::all_of(lists.begin(), lists.end(), [](const ImageList& l) { return l.empty(); });
  if (all_empty) nothing_found(patterns);
  for (std::size_t v = 1; v < lists.size(); ++v) {
    if (lists[v].size() == lists[0].size()) continue;
    throw DataError(fmt::format(
        "{} finds {} images, {} finds {}; expected as many. With numbers instead of * (%04d) a gap "
        "can be told from a shift",
        patterns[0].string(), lists[0].size(), patterns[v].string(), lists[v].size()));
  }
  const auto size = static_cast<int>(lists[0].size());
  const std::vector<std::size_t> chosen = positions(selection, lists[0].size(), patterns[0]);
  for (ImageList& list : lists) {
    ImageList taken;
    for (const std::size_t i : chosen) taken.push_back(list[i]);
    list = std::move(taken);
  }
  return {std::move(lists), selection.start.value_or(0), 0, size - 1};
}

}  // namespace

ImageList glob(const fs::path& pattern) {
  const fs::path folder = pattern.has_parent_path() ? pattern.parent_path() : fs::path(".");
  const std::string name = pattern.filename().string();
  ImageList files;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::error_code ignored;
    if (matches(name, it->path().filename().string()) && it->is_regular_file(ignored)) {
      files.push_back(it->path());
    }
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return natural_less(a.string(), b.string());
  });
  return files;
}

std::vector<std::size_t> positions(const Selection& selection, std::size_t size,
                                   const fs::path& pattern) {
  std::vector<std::size_t> out;
  const auto limit = static_cast<std::size_t>(selection.count.value_or(kLargestCount));
  for (auto i = static_cast<std::size_t>(selection.start.value_or(0));
       i < size && out.size() < limit; i += static_cast<std::size_t>(selection.step)) {
    out.push_back(i);
  }
  if (out.empty()) {
    throw DataError(fmt::format("{} finds {} images; expected more than `start: {}`",
                                pattern.string(), size, selection.start.value_or(0)));
  }
  return out;
}

void nothing_found(const std::vector<fs::path>& patterns, const std::string& what_is_there) {
  std::string tried;
  for (const fs::path& pattern : patterns) {
    fs::path folder = pattern.parent_path();
    if (folder.empty()) folder = ".";
    std::error_code error;
    const bool exists = fs::is_directory(folder, error);
    const bool numbered = folder.string().find('%') != std::string::npos;
    tried += fmt::format("\n  {} in {}{}", pattern.filename().string(), folder.string(),
                         exists || numbered ? "" : " (no such folder)");
  }
  throw DataError("no image was found; looked for" + tried + what_is_there);
}

bool natural_less(const std::string& a, const std::string& b) {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (!is_digit(a[i]) || !is_digit(b[j])) {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
      continue;
    }
    const auto digits = [](const std::string& s, std::size_t& at) {
      while (at < s.size() && s[at] == '0') ++at;
      const std::size_t first = at;
      while (at < s.size() && is_digit(s[at])) ++at;
      return std::string_view(s).substr(first, at - first);
    };
    const std::string_view x = digits(a, i);
    const std::string_view y = digits(b, j);
    if (x.size() != y.size()) return x.size() < y.size();
    if (x != y) return x < y;
  }
  const bool a_ends = i == a.size();
  const bool b_ends = j == b.size();
  if (a_ends != b_ends) return a_ends;
  return a < b;  // 7 and 07
}

Images find_images(const std::vector<fs::path>& patterns, const Selection& selection) {
  std::vector<Numbered> views;
  for (const fs::path& pattern : patterns) {
    if (const auto numbered = parse_numbered(pattern.string())) views.push_back(*numbered);
  }
  if (views.size() == patterns.size()) return numbered_lists(patterns, views, selection);
  if (!views.empty()) {
    throw DataError(
        fmt::format("{} and {}: only one of the patterns has a number in it; expected all or none",
                    patterns.front().string(), patterns.back().string()));
  }
  return listed(patterns, selection);
}

}  // namespace hypotrack
