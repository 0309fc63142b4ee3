#include <fmt/format.h>
#include <toml++/toml.h>

#include <string>
#include <utility>

#include "config/yaml.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::detail::internal {
namespace {

/// Converts TOML nodes of one document.
class TomlConverter {
 public:
  explicit TomlConverter(std::shared_ptr<const YamlOrigin> origin) : origin_(std::move(origin)) {}

  std::unique_ptr<YamlNode> convert(const toml::node& node, std::size_t depth = 0) const {
    auto out = std::make_unique<YamlNode>();
    if (const toml::table* table = node.as_table()) {
      out->kind = YamlNode::Kind::kMap;
      place(node, *out);
      check(*out, depth);
      for (const auto& [key, value] : *table)
        out->add(std::string(key.str()), convert(value, depth + 1));
    } else if (const toml::array* list = node.as_array()) {
      out->kind = YamlNode::Kind::kList;
      place(node, *out);
      check(*out, depth);
      for (const toml::node& value : *list) out->add({}, convert(value, depth + 1));
    } else {
      out = scalar(node);
      place(node, *out);
      if (out->text.empty() && !node.is_string()) refuse(*out, "a date or time");
    }
    return out;
  }

 private:
  static std::unique_ptr<YamlNode> scalar(const toml::node& node) {
    if (const auto* text = node.as_string()) return make_scalar(text->get(), false);
    if (const auto* number = node.as_integer())
      return make_scalar(fmt::to_string(number->get()), true);
    if (const auto* number = node.as_floating_point())
      return make_scalar(fmt::to_string(number->get()), true);
    if (const auto* flag = node.as_boolean())
      return make_scalar(flag->get() ? "true" : "false", true);
    return make_scalar({}, false);
  }
  void place(const toml::node& node, YamlNode& out) const {
    out.line = std::max<int>(1, static_cast<int>(node.source().begin.line));
    out.column = std::max<int>(1, static_cast<int>(node.source().begin.column));
    out.origin = origin_;
  }
  void check(const YamlNode& out, std::size_t depth) const {
    if (depth > kMaxYamlDepth) refuse(out, fmt::format("more than {} levels", kMaxYamlDepth));
  }
  [[noreturn]] static void refuse(const YamlNode& at, std::string_view what) {
    throw ConfigError(fmt::format("{}: has {}, which no setting has",
                                  describe_position(*at.origin, at.line, at.column), what));
  }

  std::shared_ptr<const YamlOrigin> origin_;
};

/// Refuses keys such as a.b.c of more than kMaxYamlDepth parts. The parser makes a table of each
/// part and would use up the stack.
void check_keys(std::string_view text, const YamlOrigin& origin) {
  int line = 1;
  std::size_t dots = 0;
  char before = 0;
  for (const char c : text) {
    const bool ends_a_key = std::string_view("=,[]{}\n").find(c) != std::string_view::npos;
    if (ends_a_key || (c == '.' && before == '.')) dots = 0;
    if (c == '.' && ++dots > kMaxYamlDepth)
      throw ConfigError(fmt::format("{}: has a key of more than {} parts, which no setting has",
                                    describe_position(origin, line, 1), kMaxYamlDepth));
    line += c == '\n';
    before = c;
  }
}

}  // namespace

std::unique_ptr<YamlNode> read_toml(std::string_view text,
                                    const std::shared_ptr<const YamlOrigin>& origin) {
  check_keys(text, *origin);
  try {
    return TomlConverter(origin).convert(toml::parse(text));
  } catch (const toml::parse_error& e) {
    throw ConfigError(
        fmt::format("{}: is no TOML: {}",
                    describe_position(*origin, static_cast<int>(e.source().begin.line),
                                      static_cast<int>(e.source().begin.column)),
                    e.description()));
  }
}

}  // namespace hypotrack::detail::internal
