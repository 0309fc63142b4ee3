#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <utility>

#include "base/numbers.hpp"
#include "config/read_value.hpp"
#include "hypotrack/api/text.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack {

using detail::fail_at;
using detail::fail_type;
using detail::read_double;
using detail::read_text;
using detail::with_range;

ParamVisitor::~ParamVisitor() = default;

/// The reading visitor, with one level per open section or list item. A level without a map belongs
/// to an item of a default list that the file omits; it changes nothing.
struct ParamReader::Impl : public ParamVisitor {
  struct Level {
    ConfigNode node;
    bool reads = true;
    std::vector<std::string> known;    ///< keys of the struct, in its order
    std::vector<std::string> missing;  ///< required keys that the file lacks
  };

  Impl(ConfigNode node, std::vector<std::string> also) : also_allowed(std::move(also)) {
    if (node.defined() && !node.is_map()) fail_type(node, "a map of parameters");
    levels.push_back({std::move(node), true, {}, {}});
  }

  /// Returns the value of a key of the current map, if it is given.
  std::optional<ConfigNode> take(std::string_view key, const ParamInfo& info) {
    Level& level = levels.back();
    if (!level.reads) return std::nullopt;
    // An optional scalar is visited twice: for its presence, then for its value.
    if (level.known.empty() || level.known.back() != key) level.known.emplace_back(key);
    ConfigNode node = level.node.get(key);
    if (node.defined()) return node;
    if (info.required) level.missing.emplace_back(key);
    return std::nullopt;
  }

  void check_keys(const Level& level, const std::vector<std::string>& extra) const {
    if (!level.reads) return;
    std::vector<std::string> allowed = level.known;
    allowed.insert(allowed.end(), extra.begin(), extra.end());
    const std::set<std::string_view> known(allowed.begin(), allowed.end());
    for (const std::string& key : level.node.keys()) {
      if (!known.contains(key)) detail::fail_unknown(level.node, key, allowed);
    }
    if (level.missing.empty()) return;
    fail_at(level.node.get(level.missing.front()), "required key is missing");
  }

  void on_bool(std::string_view key, bool& value, const ParamInfo& info) override {
    const auto node = take(key, info);
    if (!node) return;
    const std::string& text = node->scalar();
    if (node->is_plain() && (text == "true" || text == "false")) {
      value = text == "true";
      return;
    }
    fail_type(*node, "true or false (yes, no, on and off are no bools in YAML 1.2)");
  }

  void on_int(std::string_view key, std::int64_t& value, std::int64_t lowest, std::int64_t highest,
              const ParamInfo& info) override {
    const auto node = take(key, info);
    if (!node) return;
    // Mention the type's own limits only if they are what rejects the value.
    std::string expected = with_range("an integer", info.min, info.max, info.unit);
    const auto number =
        node->is_plain() ? detail::parse_integer(node->scalar()) : std::optional<std::int64_t>();
    if (!number) fail_type(*node, expected);
    const auto wide = static_cast<long double>(*number);
    const bool in_range = wide >= info.min && wide <= info.max;
    if (in_range && *number >= lowest && *number <= highest) {
      value = *number;
      return;
    }
    if (in_range) {
      if (info.min > static_cast<double>(lowest)) lowest = static_cast<std::int64_t>(info.min);
      if (info.max < static_cast<double>(highest)) highest = static_cast<std::int64_t>(info.max);
      expected = fmt::format("an integer from {} to {}", lowest, highest);
    }
    fail_at(*node, fmt::format("{} is out of range; expected {}", node->scalar(), expected));
  }

  void on_double(std::string_view key, double& value, const ParamInfo& info) override {
    if (const auto node = take(key, info)) value = read_double(*node, info);
  }

  void on_string(std::string_view key, std::string& value, const ParamInfo& info) override {
    if (const auto node = take(key, info)) value = read_text(*node, "a text");
  }

  void on_path(std::string_view key, std::filesystem::path& value, const ParamInfo& info) override {
    const auto node = take(key, info);
    if (!node) return;
    const std::filesystem::path path = read_text(*node, "a path");
    if (path.empty() && info.required) fail_type(*node, "a path");
    const bool is_file = !path.empty() && !path.native().starts_with(detail::kAttached);
    value = is_file ? (node->directory() / path).lexically_normal() : path;
  }

  void on_enum(std::string_view key, int& value, std::span<const std::string_view> names,
               const ParamInfo& info) override {
    const auto node = take(key, info);
    if (!node) return;
    const std::string& text = node->scalar();
    const auto found = std::find(names.begin(), names.end(), text);
    if (node->is_scalar() && !node->is_null() && found != names.end()) {
      value = static_cast<int>(found - names.begin());
      return;
    }
    const std::vector<std::string> words(names.begin(), names.end());
    const std::string hint = node->is_null() ? "" : did_you_mean(text, words);
    fail_at(*node, fmt::format("expected one of {}; found {}{}", fmt::join(words, ", "),
                               detail::describe_value(*node), hint));
  }

  void on_doubles(std::string_view key, std::vector<double>& value, std::size_t fixed_size,
                  const ParamInfo& info) override {
    const auto node = take(key, info);
    if (!node) return;
    const std::string numbers = fixed_size ? fmt::format("{} numbers", fixed_size) : "numbers";
    const std::string expected = "a list of " + with_range(numbers, info.min, info.max, info.unit);
    if (!node->is_list()) fail_type(*node, expected);
    if (fixed_size && node->size() != fixed_size) {
      fail_at(*node, fmt::format("expected {}, found {}", expected, node->size()));
    }
    value.clear();
    for (std::size_t i = 0; i < node->size(); ++i) value.push_back(read_double(node->at(i), info));
  }

  void on_strings(std::string_view key, std::vector<std::string>& value,
                  const ParamInfo& info) override {
    const auto node = take(key, info);
    if (!node) return;
    if (!node->is_list()) fail_type(*node, "a list of texts");
    value.clear();
    for (std::size_t i = 0; i < node->size(); ++i) {
      value.push_back(read_text(node->at(i), "a text"));
    }
  }

  void on_config(std::string_view key, ConfigNode& value, const ParamInfo& info) override {
    if (const auto node = take(key, info)) {
      value = *node;
    } else if (levels.back().node.is_map()) {
      value = value.placed_at(levels.back().node.get(key).path());
    }
  }

  bool enter_section(std::string_view key, const ParamInfo& info) override {
    const auto node = take(key, info);
    if (!node) return false;
    if (!node->is_map()) fail_type(*node, "a map of parameters");
    levels.push_back({*node, true, {}, {}});
    return true;
  }

  void leave_section() override {
    check_keys(levels.back(), {});
    levels.pop_back();
  }

  std::size_t enter_list(std::string_view key, std::size_t size, const ParamInfo& info) override {
    const auto node = take(key, info);
    if (node && !node->is_list()) fail_type(*node, "a list of maps");
    lists.push_back(node.value_or(ConfigNode()));
    return node ? node->size() : size;
  }

  bool enter_item(std::size_t index) override {
    if (!lists.back().defined()) {
      levels.push_back({ConfigNode(), false, {}, {}});
      return false;
    }
    const ConfigNode node = lists.back().at(index);
    if (!node.is_map()) fail_type(node, "a map of parameters");
    levels.push_back({node, true, {}, {}});
    return true;
  }

  void leave_item() override { leave_section(); }
  void leave_list() override { lists.pop_back(); }

  bool enter_optional(std::string_view key, bool, const ParamInfo& info) override {
    return take(key, info).has_value();
  }

  std::vector<std::string> also_allowed;
  std::vector<Level> levels;
  std::vector<ConfigNode> lists;
};

ParamReader::ParamReader(ConfigNode node, std::vector<std::string> also_allowed)
    : impl_(std::make_unique<Impl>(std::move(node), std::move(also_allowed))) {}
ParamReader::~ParamReader() = default;

ParamVisitor& ParamReader::visitor() { return *impl_; }
void ParamReader::finish() { impl_->check_keys(impl_->levels.back(), impl_->also_allowed); }

}  // namespace hypotrack
