#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/numbers.hpp"
#include "config/read_value.hpp"
#include "config/yaml.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack {
namespace {

using detail::make_scalar;
using detail::YamlNode;

std::unique_ptr<YamlNode> make_container(YamlNode::Kind kind) {
  auto node = std::make_unique<YamlNode>();
  node->kind = kind;
  return node;
}

/// Builds a YAML tree of the values.
class DumpVisitor : public ParamVisitor {
 public:
  explicit DumpVisitor(YamlNode& root) : open_{&root} {}

 protected:
  void on_bool(std::string_view key, bool& value, const ParamInfo&) override {
    add(key, make_scalar(value ? "true" : "false", true));
  }
  void on_int(std::string_view key, std::int64_t& value, std::int64_t, std::int64_t,
              const ParamInfo&) override {
    add(key, make_scalar(std::to_string(value), true));
  }
  void on_double(std::string_view key, double& value, const ParamInfo& info) override {
    // A NaN default means "not given" and has no YAML form, so the key is left out.
    if (!std::isnan(value)) add(key, number(value, info));
  }
  void on_string(std::string_view key, std::string& value, const ParamInfo&) override {
    add(key, make_scalar(value, false));
  }
  void on_path(std::string_view key, std::filesystem::path& value, const ParamInfo&) override {
    const bool is_file = !value.empty() && !value.native().starts_with(detail::kAttached);
    const auto path = is_file ? std::filesystem::absolute(value).lexically_normal() : value;
    add(key, make_scalar(path.string(), false));
  }
  void on_enum(std::string_view key, int& value, std::span<const std::string_view> names,
               const ParamInfo&) override {
    add(key, make_scalar(std::string(names[static_cast<std::size_t>(value)]), false));
  }
  void on_doubles(std::string_view key, std::vector<double>& value, std::size_t,
                  const ParamInfo& info) override {
    YamlNode& list = add(key, make_container(YamlNode::Kind::kList));
    for (const double item : value) list.add("", number(item, info));
  }
  void on_strings(std::string_view key, std::vector<std::string>& value,
                  const ParamInfo&) override {
    YamlNode& list = add(key, make_container(YamlNode::Kind::kList));
    for (const std::string& item : value) list.add("", make_scalar(item, false));
  }
  void on_config(std::string_view key, ConfigNode& value, const ParamInfo&) override {
    if (!value.defined()) return;
    auto origin = std::make_shared<detail::YamlOrigin>();
    origin->name = value.where();
    add(key, detail::read_yaml(value.to_yaml(), origin));
  }

  bool enter_section(std::string_view key, const ParamInfo&) override {
    open_.push_back(&add(key, make_container(YamlNode::Kind::kMap)));
    return true;
  }
  void leave_section() override { open_.pop_back(); }
  std::size_t enter_list(std::string_view key, std::size_t size, const ParamInfo&) override {
    open_.push_back(&add(key, make_container(YamlNode::Kind::kList)));
    return size;
  }
  bool enter_item(std::size_t) override {
    open_.push_back(&add("", make_container(YamlNode::Kind::kMap)));
    return false;
  }
  void leave_item() override { open_.pop_back(); }
  void leave_list() override { open_.pop_back(); }
  bool enter_optional(std::string_view, bool has_value, const ParamInfo&) override {
    return has_value;
  }

 private:
  static std::unique_ptr<YamlNode> number(double value, const ParamInfo& info) {
    return make_scalar(detail::format_number(value, info.to_si), true);
  }

  YamlNode& add(std::string_view key, std::unique_ptr<YamlNode> value) {
    return open_.back()->add(std::string(key), std::move(value));
  }

  std::vector<YamlNode*> open_;
};

/// Collects one line per parameter; sections and list items are indented below their key.
class HelpVisitor : public ParamVisitor {
 public:
  std::string text() const {
    std::size_t keys = 0;
    std::size_t types = 0;
    for (const Line& line : lines_) {
      keys = std::max(keys, line.key.size());
      types = std::max(types, std::min(line.type.size(), kWidestType));
    }
    std::string text;
    for (const Line& line : lines_) {
      std::string row =
          fmt::format("{:<{}}  {:<{}}  {}", line.key, keys, line.type, types, line.help);
      row.erase(row.find_last_not_of(' ') + 1);
      text += row + "\n";
    }
    return text;
  }

 protected:
  void on_bool(std::string_view key, bool& value, const ParamInfo& info) override {
    add(key, "true or false", value ? "true" : "false", info);
  }
  void on_int(std::string_view key, std::int64_t& value, std::int64_t, std::int64_t,
              const ParamInfo& info) override {
    add(key, ranged("integer", info), std::to_string(value), info);
  }
  void on_double(std::string_view key, double& value, const ParamInfo& info) override {
    const std::string number = detail::format_number(value, info.to_si);
    add(key, ranged("number", info), std::isnan(value) ? "" : number, info);
  }
  void on_string(std::string_view key, std::string& value, const ParamInfo& info) override {
    add(key, "text", value.empty() ? "" : fmt::format("\"{}\"", value), info);
  }
  void on_path(std::string_view key, std::filesystem::path& value, const ParamInfo& info) override {
    add(key, "path", value.string(), info);
  }
  void on_enum(std::string_view key, int& value, std::span<const std::string_view> names,
               const ParamInfo& info) override {
    add(key, fmt::format("one of {}", fmt::join(names, ", ")),
        std::string(names[static_cast<std::size_t>(value)]), info);
  }
  void on_doubles(std::string_view key, std::vector<double>& value, std::size_t fixed_size,
                  const ParamInfo& info) override {
    std::vector<std::string> items;
    for (const double item : value) items.push_back(detail::format_number(item, info.to_si));
    const std::string type = fixed_size ? fmt::format("{} numbers", fixed_size) : "numbers";
    add(key, ranged(type, info), items.empty() ? "" : fmt::format("[{}]", fmt::join(items, ", ")),
        info);
  }
  void on_strings(std::string_view key, std::vector<std::string>& value,
                  const ParamInfo& info) override {
    add(key, "texts", value.empty() ? "" : fmt::format("[{}]", fmt::join(value, ", ")), info);
  }
  void on_config(std::string_view key, ConfigNode&, const ParamInfo& info) override {
    add(key, "a map with `type`, or whatever its reader takes", "", info);
  }

  bool enter_section(std::string_view key, const ParamInfo& info) override {
    add(key, "a map of", "", info);
    ++depth_;
    return true;
  }
  void leave_section() override { --depth_; }
  std::size_t enter_list(std::string_view key, std::size_t, const ParamInfo& info) override {
    add(key, "a list of", "", info);
    ++depth_;
    return 1;
  }
  bool enter_item(std::size_t) override { return true; }
  void leave_item() override {}
  void leave_list() override { --depth_; }
  bool enter_optional(std::string_view, bool has_value, const ParamInfo&) override {
    optional_without_default_ = !has_value;
    return true;
  }

 private:
  static constexpr std::size_t kWidestType = 44;

  struct Line {
    std::string key;
    std::string type;  ///< type, range, unit and default
    std::string help;
  };

  static std::string ranged(std::string_view type, const ParamInfo& info) {
    const std::string range = detail::describe_range(info.min, info.max, info.unit);
    if (!range.empty()) return fmt::format("{} {}", type, range);
    return info.unit.empty() ? std::string(type) : fmt::format("{} in {}", type, info.unit);
  }

  void add(std::string_view key, std::string type, const std::string& value,
           const ParamInfo& info) {
    const bool none = std::exchange(optional_without_default_, false);
    if (info.required) {
      type += ", required";
    } else if (none) {
      type += ", optional";
    } else if (!value.empty()) {
      type += ", default " + value;
    }
    lines_.push_back(
        {std::string(2 * depth_, ' ') + std::string(key), std::move(type), std::string(info.help)});
  }

  std::vector<Line> lines_;
  std::size_t depth_ = 1;
  bool optional_without_default_ = false;
};

}  // namespace

std::string dump_params(void* params, ParamVisit visit) {
  const auto root = make_container(YamlNode::Kind::kMap);
  DumpVisitor visitor(*root);
  visit(params, visitor);
  return root->entries.empty() ? "" : detail::write_yaml(*root);
}

std::string describe_params(void* params, ParamVisit visit) {
  HelpVisitor visitor;
  visit(params, visitor);
  return visitor.text();
}

}  // namespace hypotrack
