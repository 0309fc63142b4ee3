#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/former_keys.hpp"
#include "config/text_lines.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::detail::internal {
namespace {

constexpr std::string_view kDotted = "tracker.";

/// A piece of a text that another replaces.
struct Edit {
  std::size_t begin, end;
  std::string text;
};

class Migration {
 public:
  Migration(const std::string& text, std::string name)
      : text_(text), lines_(text), origin_(std::make_shared<YamlOrigin>()) {
    origin_->name = std::move(name);
  }

  std::string apply() {
    const auto root = read_yaml(text_, origin_);
    look_at(*root);
    std::string out = text_;
    std::ranges::sort(edits_, std::greater(), &Edit::begin);
    for (const Edit& edit : edits_) out.replace(edit.begin, edit.end - edit.begin, edit.text);
    return out;
  }

 private:
  using Entry = YamlNode::Entry;

  [[noreturn]] void refuse(int line, int column, std::string_view why) const {
    throw ConfigError(fmt::format("{}: {}; rewrite `tracker` yourself",
                                  describe_position(*origin_, line, column), why));
  }
  std::size_t at(const Entry& entry) const { return lines_.at(entry.line, entry.column); }
  std::size_t at(const YamlNode& node) const { return lines_.at(node.line, node.column); }
  bool is_flow(const YamlNode& map) const {
    return at(map) < text_.size() && text_[at(map)] == '{';
  }

  void look_at(const YamlNode& node) {
    if (node.kind == YamlNode::Kind::kScalar) rename(at(node), node.text);
    for (const Entry& entry : node.entries) {
      if (node.kind == YamlNode::Kind::kMap) {
        if (entry.key == "tracker.evidence" && entry.value->plain && entry.value->text == "false") {
          edits_.push_back({at(entry), at(*entry.value) + 5, "judge: none"});
          continue;
        }
        rename(at(entry), entry.key);
        rename_in_place(node, entry);
        if (entry.key == kTracker && has_former(*entry.value)) {
          rewrite(node, entry);
          continue;
        }
      }
      look_at(*entry.value);
    }
  }

  /// Renames a former path, such as `tracker.recovery.run`, that begins there, maybe in quotes.
  void rename(std::size_t begin, std::string_view text) {
    const auto is_of_paths = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '.';
    };
    if (!std::ranges::all_of(text, is_of_paths)) return;
    if (begin < text_.size() && (text_[begin] == '"' || text_[begin] == '\'')) ++begin;
    if (!text.starts_with(kDotted)) {
      const std::string now = path_today(text);
      if (now != text && text_.compare(begin, text.size(), text) == 0)
        edits_.push_back({begin, begin + text.size(), now});
      return;
    }
    const std::string_view rest = text.substr(kDotted.size());
    const FormerKey* const key = former_key(rest.substr(0, rest.find('.')));
    const bool is_there = text_.compare(begin, kDotted.size(), kDotted) == 0;
    if (key && is_there)
      edits_.push_back({begin, begin + kDotted.size() + key->key.size(), path_now(*key)});
  }

  /// Gives a key or word its name of today, if it has another one.
  void rename_in_place(const YamlNode& map, const Entry& entry) {
    const auto now = new_name(map, entry);
    if (!now) return;
    const std::string& before = now->is_of_value ? entry.value->text : entry.key;
    std::size_t begin = now->is_of_value ? at(*entry.value) : at(entry);
    if (begin < text_.size() && (text_[begin] == '"' || text_[begin] == '\'')) ++begin;
    if (text_.compare(begin, before.size(), before) == 0)
      edits_.push_back({begin, begin + before.size(), std::string(now->name)});
  }

  static bool has_former(const YamlNode& map) {
    if (map.kind != YamlNode::Kind::kMap || map.entries.empty()) return false;
    return std::ranges::all_of(map.entries, [](const Entry& entry) {
      return entry.key == kFrom || entry.key == kEvidence || former_key(entry.key);
    });
  }

  /// Where a key goes: the scene itself (empty) or a map of it.
  static std::string_view place_of(const Entry& entry) {
    if (entry.key == kEvidence) return kNone;
    const FormerKey* const key = former_key(entry.key);
    return key ? key->place : kTracker;
  }

  void rewrite(const YamlNode& parent, const Entry& tracker) {
    // There it replaces the whole map, which its successors would not.
    if (parent.parent)
      refuse(tracker.line, tracker.column,
             "found `tracker` with its former keys below another key");
    for (const Entry& entry : tracker.value->entries) {
      const std::string_view place = place_of(entry);
      const std::string_view now = place == kNone ? kJudge : place.empty() ? entry.key : place;
      const Entry* const there = now == kTracker ? nullptr : parent.find(now);
      if (there) refuse(there->line, there->column, fmt::format("`{}` is there already", now));
    }
    if (is_flow(*tracker.value))
      rewrite_flow(parent, tracker);
    else
      rewrite_block(tracker);
  }

  /// Returns the end of a map in braces, after its last one.
  std::size_t end_of_flow(const YamlNode& map) const {
    int depth = 0;
    char quote = 0;
    for (std::size_t i = at(map); i < text_.size(); ++i) {
      const char c = text_[i];
      if (quote) {
        if (c == '\\' && quote == '"') ++i;
        if (c == quote) quote = 0;
      } else if (c == '#' && text_[i - 1] == ' ') {
        refuse(map.line, map.column, "found a comment between braces");
      } else if (c == '"' || c == '\'') {
        quote = c;
      } else if (c == '{' || c == '[') {
        ++depth;
      } else if ((c == '}' || c == ']') && --depth == 0) {
        return i + 1;
      }
    }
    return text_.size();
  }

  std::string slice(std::size_t begin, std::size_t end) const {
    std::string out = text_.substr(begin, end - begin);
    while (!out.empty() && std::string_view(" \t\r\n,").find(out.back()) != std::string_view::npos)
      out.pop_back();
    return out;
  }

  void rewrite_flow(const YamlNode& parent, const Entry& tracker) {
    const std::vector<Entry>& entries = tracker.value->entries;
    const std::size_t end = end_of_flow(*tracker.value);
    if (tracker.line != tracker.value->line)
      refuse(tracker.line, tracker.column, "found braces on a line of their own");
    std::vector<std::string> whole;
    std::map<std::string_view, std::string> groups;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const Entry& entry = entries[i];
      const std::size_t stop = i + 1 < entries.size() ? at(entries[i + 1]) : end - 1;
      const std::string_view place = place_of(entry);
      if (place == kNone) {
        if (entry.value->text == "false") whole.emplace_back("judge: none");
      } else if (place == kTracker) {
        whole.push_back("tracker: " + slice(at(*entry.value), stop));
      } else if (place.empty()) {
        whole.push_back(slice(at(entry), stop));
      } else {
        std::string& group = groups[place];
        group += (group.empty() ? "" : ", ") + slice(at(entry), stop);
      }
    }
    for (const auto& [place, group] : groups)
      whole.push_back(
          fmt::format("{}: {{{}{}}}", place, place == kJudge ? "type: network, " : "", group));
    const std::string between =
        is_flow(parent) ? ", "
                        : "\n" + std::string(static_cast<std::size_t>(tracker.column - 1), ' ');
    std::string text;
    for (const std::string& each : whole) text += (text.empty() ? "" : between) + each;
    if (text.empty() && is_flow(parent))
      refuse(tracker.line, tracker.column, "found nothing to keep between braces");
    edits_.push_back({at(tracker), end, text});
  }

  /// Returns the line after the last one of a map that is written in lines.
  int end_of_block(const Entry& tracker, int column) const {
    int end = tracker.line + 1;
    for (int line = end; line <= lines_.count(); ++line) {
      const auto indent = lines_.indent(line);
      if (indent && *indent < column - 1) break;
      if (indent) end = line + 1;
    }
    return end;
  }

  void rewrite_block(const Entry& tracker) {
    const std::vector<Entry>& entries = tracker.value->entries;
    const int column = entries.front().column;
    if (lines_.indent(tracker.line) != tracker.column - 1 || tracker.line == entries.front().line)
      refuse(tracker.line, tracker.column, "found `tracker` within a line");
    const std::string margin(static_cast<std::size_t>(tracker.column - 1), ' ');
    const std::string inner(static_cast<std::size_t>(column - 1), ' ');
    const std::string head = lines_.of(tracker.line, tracker.line + 1);
    const std::size_t comment = head.find(" #");
    std::string text = comment == std::string::npos ? "" : margin + head.substr(comment + 1);
    std::map<std::string_view, std::string> groups;
    int begin = tracker.line + 1;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      int end = i + 1 < entries.size() ? entries[i + 1].line : end_of_block(tracker, column);
      while (end > entries[i].line + 1 && !lines_.indent(end - 1))
        --end;  // the next one's comments
      std::string chunk = lines_.of(begin, end);
      if (!chunk.ends_with('\n')) chunk += '\n';
      const std::string comments = lines_.of(begin, entries[i].line);
      begin = end;
      const std::string_view place = place_of(entries[i]);
      if (place == kNone) {
        text += dedented(comments, column - tracker.column);
        if (entries[i].value->text == "false") text += margin + "judge: none\n";
      } else if (place == kTracker) {
        text += dedented(comments, column - tracker.column) + margin +
                "tracker: " + slice(at(*entries[i].value), lines_.begin(end)) + "\n";
      } else if (place.empty()) {
        text += dedented(chunk, column - tracker.column);
      } else {
        groups[place] += chunk;
      }
    }
    for (const auto& [place, group] : groups)
      text += fmt::format("{}{}:\n{}{}", margin, place,
                          place == kJudge ? inner + "type: network\n" : "", group);
    edits_.push_back({lines_.begin(tracker.line), lines_.begin(begin), text});
  }

  const std::string& text_;
  const Lines lines_;
  std::shared_ptr<YamlOrigin> origin_;
  std::vector<Edit> edits_;
};

void sort_keys(YamlNode& node) {
  if (node.kind == YamlNode::Kind::kMap) std::ranges::sort(node.entries, {}, &YamlNode::Entry::key);
  for (YamlNode::Entry& entry : node.entries) sort_keys(*entry.value);
}

std::string sorted_text(YamlNode& node) {
  sort_keys(node);
  return write_yaml(node);
}

}  // namespace

std::string migrate(const std::string& text, const std::string& name) {
  std::string out = Migration(text, name).apply();
  out = Migration(out, name).apply();  // keys that have moved may have another name there
  if (out == text) return out;
  if (text.find("\r\n") != std::string::npos) out = with_windows_lines(out);
  auto origin = std::make_shared<YamlOrigin>();
  origin->name = name;
  const auto before = read_yaml(text, origin);
  (void)move_former_keys(*before);
  std::string now;
  try {
    now = sorted_text(*read_yaml(out, origin));
  } catch (const ConfigError&) {  // refused below
  }
  if (now.empty() || (!before->find("scenes") && sorted_text(*before) != now))
    throw ConfigError(fmt::format(
        "{}: its former keys cannot be rewritten without a change of meaning; do it yourself",
        name));
  return out;
}

}  // namespace hypotrack::detail::internal
