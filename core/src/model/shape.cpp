#include "hypotrack/shape.hpp"

#include <fmt/format.h>

namespace hypotrack {
namespace {

/// The parameter struct of a model's shape values; names and bounds are the model's.
struct Values {
  std::vector<ShapeParameter> all;
  void visit(ParamVisitor& v) {
    for (ShapeParameter& p : all)
      v(p.name, p.value, {.help = "shape parameter", .min = p.lower, .max = p.upper});
  }
};

}  // namespace

std::vector<double> read_shape(const ShapeSettings& settings,
                               std::span<const ShapeParameter> parameters) {
  Values values{{parameters.begin(), parameters.end()}};
  for (ShapeParameter& p : values.all) p.value = p.neutral;
  if (!settings.shape_file.empty())
    values = ParamReader(ConfigNode::load(settings.shape_file)).read(std::move(values));
  if (settings.shape.defined()) values = ParamReader(settings.shape).read(std::move(values));
  std::vector<double> read;
  for (const ShapeParameter& p : values.all) read.push_back(p.value);
  return read;
}

std::string shape_yaml(std::span<const ShapeParameter> parameters) {
  std::string text;
  for (const ShapeParameter& p : parameters) text += fmt::format("{}: {:.4f}\n", p.name, p.value);
  return text;
}

}  // namespace hypotrack
