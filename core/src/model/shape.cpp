#include "hypotrack/plugin/shape.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>

#include "hypotrack/api/error.hpp"

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

Eigen::MatrixXd shape_correlations(std::span<const ShapeParameter> parameters) {
  const auto size = static_cast<Eigen::Index>(parameters.size());
  Eigen::MatrixXd out = Eigen::MatrixXd::Identity(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const ShapeParameter& p = parameters[static_cast<std::size_t>(i)];
    if (p.correlations.empty()) continue;
    if (std::ssize(p.correlations) != i)
      throw DataError(fmt::format(
          "the shape parameter '{}' has {} correlations, expected {}, one with each before it",
          p.name, p.correlations.size(), i));
    for (Eigen::Index j = 0; j < i; ++j)
      out(i, j) = out(j, i) = p.correlations[static_cast<std::size_t>(j)];
  }
  if (!out.allFinite() || Eigen::LLT<Eigen::MatrixXd>(out).info() != Eigen::Success)
    throw DataError(
        "the correlations of the shape parameters are those of no distribution; expected a "
        "positive definite matrix");
  return out;
}

}  // namespace hypotrack
