#include "model_info.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "config/overrides.hpp"
#include "config/yaml.hpp"
#include "hypotrack/api/config.hpp"
#include "hypotrack/plugin/model.hpp"

namespace hypotrack::app {
namespace {

/// Formats a heading and names in lines of at most 100 characters.
std::string listed(const std::string& heading, const std::vector<std::string>& names) {
  constexpr std::size_t kWidth = 100;
  if (names.empty()) return "";
  std::string out = heading + "\n", line = " ";
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string word = names[i] + (i + 1 < names.size() ? "," : "");
    if (line.size() + 1 + word.size() > kWidth) {
      out += line + "\n";
      line = " ";
    }
    line += " " + word;
  }
  return out + line + "\n";
}

std::string in_words(const ModelInfo& info) {
  const std::size_t joints = info.state.size() - static_cast<std::size_t>(kPoseSize);
  return joints == 0 ? "6, of its pose"
                     : fmt::format("{}, 6 of its pose and {} of its joints",
                                   info.degrees_of_freedom, joints);
}

}  // namespace

ModelInfo describe_model(PluginLoader& plugins, std::string_view name,
                         const std::vector<std::string>& settings) {
  const std::string where = "plugins info";
  auto node =
      detail::read_document(fmt::format("type: {}", name), where, std::filesystem::current_path());
  for (const std::string& setting : settings) detail::apply_override(*node, setting, setting);
  const auto model = plugins.make<Model>(ConfigNode::parse(detail::write_yaml(*node), where));
  ModelInfo info;
  // A unit quaternion is four numbers of three degrees of freedom.
  info.degrees_of_freedom = model->dimension() - 1;
  for (const Parameter& parameter : model->data().parameters) info.state.push_back(parameter.name);
  for (const Landmark& landmark : model->data().landmarks) info.landmarks.push_back(landmark.name);
  for (const ShapeParameter& shape : model->shape_parameters()) info.shape.push_back(shape.name);
  return info;
}

std::string format_model(const ModelInfo& info) {
  return fmt::format("degrees of freedom: {}\n", in_words(info)) + listed("state", info.state) +
         listed("landmarks", info.landmarks) + listed("shape parameters", info.shape);
}

std::string format_model_markdown(const ModelInfo& info) {
  const auto sentence = [](const char* heading, const std::vector<std::string>& names) {
    return names.empty() ? std::string()
                         : fmt::format("\n{}: `{}`.\n", heading, fmt::join(names, "`, `"));
  };
  return fmt::format("\nDegrees of freedom: {}.\n", in_words(info)) +
         sentence("State", info.state) + sentence("Landmarks", info.landmarks) +
         sentence("Shape parameters", info.shape);
}

}  // namespace hypotrack::app
