#include <cmath>
#include <vector>

#include "base/numbers.hpp"
#include "config/yaml_reader.hpp"
#include "config/yaml_writer.hpp"
#include "hypotrack/params.hpp"

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
    // A default of not-a-number means "not given", and cannot be read: leave it not given.
    if (!std::isnan(value)) add(key, number(value, info));
  }
  void on_string(std::string_view key, std::string& value, const ParamInfo&) override {
    add(key, make_scalar(value, false));
  }
  void on_path(std::string_view key, std::filesystem::path& value, const ParamInfo&) override {
    const auto path = value.empty() ? value : std::filesystem::absolute(value).lexically_normal();
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

}  // namespace

std::string dump_params(void* params, ParamVisit visit) {
  const auto root = make_container(YamlNode::Kind::kMap);
  DumpVisitor visitor(*root);
  visit(params, visitor);
  return root->entries.empty() ? "" : detail::write_yaml(*root);
}

}  // namespace hypotrack
