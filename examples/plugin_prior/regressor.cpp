// An objective with a Jacobian of its own: pulls models to what a pose regressor says of a frame.
//
//   FILE   a table `frame,NAME,NAME,...`, one row per frame; NAMEs are those of the scene's
//          parameters: `hand.position_x`, `hand.rotation_w`, `hand.index_flexion_1`
#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <hypotrack/plugin/plugin.hpp>
#include <map>
#include <sstream>

namespace {

std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> out;
  std::istringstream text(line);
  for (std::string field; std::getline(text, field, ',');) out.push_back(field);
  return out;
}

double number(const std::string& text, const std::string& where) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw hypotrack::DataError(where + ": '" + text + "' is no number");
  return value;
}

}  // namespace

/// The cost is the sum of squared differences to the regressor's pose, in units of the sigmas.
class Regressor final : public hypotrack::Objective, public hypotrack::ResidualTerm {
 public:
  struct Params {
    std::filesystem::path file;
    double position_sigma = 0.03, angle_sigma = 0.3;
    void visit(hypotrack::ParamVisitor& v) {
      v("file", file, {.help = "table of the regressor's poses", .required = true});
      v("position_sigma_mm", position_sigma,
        {.help = "how far off a position may be: there it costs 1",
         .min = 0.1,
         .max = 1e4,
         .unit = "mm",
         .to_si = 1e-3});
      v("angle_sigma_rad", angle_sigma,
        {.help = "how far off an angle or a rotation may be: there it costs 1",
         .min = 1e-3,
         .max = 10});
    }
  };

  Regressor(const Params& params, hypotrack::PluginContext& context) {
    const std::string file = params.file.string();
    std::ifstream csv(params.file);
    std::string line;
    if (!std::getline(csv, line)) throw hypotrack::DataError(file + ": cannot be read");
    const std::vector<std::string> names = fields(line);
    const auto& items = context.scene().items();
    for (std::size_t m = 0; m < items.size(); ++m) {
      for (int k = 0; k < items[m].model->dimension(); ++k)
        add(params, context.scene().parameters(), items[m].offset + k, static_cast<int>(m), names);
    }
    if (pulls_.empty())
      throw hypotrack::DataError(file + ": no column is a parameter of the scene, such as '" +
                                 context.scene().parameters()[0].name + "'");
    while (std::getline(csv, line)) {
      const std::vector<std::string> row = fields(line);
      if (row.size() != names.size())
        throw hypotrack::DataError(file + ": a row has " + std::to_string(row.size()) +
                                   " fields, expected " + std::to_string(names.size()));
      std::vector<double>& pose = poses_[static_cast<int>(number(row[0], file))];
      for (const Pull& pull : pulls_) pose.push_back(number(row[pull.field], file));
    }
  }

 private:
  bool do_needs_rendering() const override { return false; }
  hypotrack::ImageUse do_image_use() const override {
    return {.color = false, .mask = false, .depth = false};
  }

  void do_prepare(const hypotrack::Observation& observation) override {
    const auto found = poses_.find(observation.frame);
    knows_ = found != poses_.end();
    if (!knows_) return;
    // A quaternion and its opposite are the same rotation: take the one near the start's.
    std::map<int, double> same;
    for (std::size_t i = 0; i < pulls_.size(); ++i) {
      pulls_[i].target = found->second[i];
      if (pulls_[i].is_quaternion)
        same[pulls_[i].model] += pulls_[i].target * observation.start[pulls_[i].parameter];
    }
    for (Pull& pull : pulls_)
      if (pull.is_quaternion && same[pull.model] < 0) pull.target = -pull.target;
  }

  double do_cost(const hypotrack::RenderedHypothesis& hypothesis) const override {
    double sum = 0;
    for (const Pull& pull : pulls_) sum += std::pow(residual(pull, hypothesis.state), 2);
    return sum;
  }

  const hypotrack::ResidualTerm* do_residual_term() const override { return this; }
  std::int64_t do_residual_count() const override {
    return static_cast<std::int64_t>(pulls_.size());
  }
  void do_write_residuals(const hypotrack::RenderedHypothesis& hypothesis,
                          std::span<float> residuals) const override {
    for (std::size_t i = 0; i < residuals.size(); ++i)
      residuals[i] = static_cast<float>(residual(pulls_[i], hypothesis.state));
  }

  bool do_has_jacobian() const override { return true; }
  void do_write_jacobian(const hypotrack::RenderedHypothesis& hypothesis,
                         std::span<float> residuals, hypotrack::Jacobian& jacobian) const override {
    do_write_residuals(hypothesis, residuals);
    if (!knows_) return;  // the Jacobian comes filled with zeros
    for (std::size_t i = 0; i < residuals.size(); ++i)
      jacobian(static_cast<Eigen::Index>(i), pulls_[i].parameter) =
          static_cast<float>(pulls_[i].factor);
  }

  /// One residual: a parameter should have the regressor's value.
  struct Pull {
    int parameter;
    int model;
    bool is_quaternion;
    double factor;
    std::size_t field;  // of the table
    double target = 0;
  };

  void add(const Params& params, const std::vector<hypotrack::Parameter>& parameters, int k,
           int model, const std::vector<std::string>& names) {
    const hypotrack::Parameter& parameter = parameters[static_cast<std::size_t>(k)];
    const auto found = std::find(names.begin(), names.end(), parameter.name);
    if (found == names.end()) return;
    const bool quaternion = parameter.kind == hypotrack::ParameterKind::quaternion;
    // A small rotation changes a quaternion by half its rotation vector.
    const double factor = hypotrack::is_in_metres(parameter.kind)
                              ? 1 / params.position_sigma
                              : (quaternion ? 2 : 1) / params.angle_sigma;
    pulls_.push_back(
        {k, model, quaternion, factor, static_cast<std::size_t>(found - names.begin())});
  }

  double residual(const Pull& pull, std::span<const double> state) const {
    if (!knows_) return 0;
    return pull.factor * (state[static_cast<std::size_t>(pull.parameter)] - pull.target);
  }

  std::vector<Pull> pulls_;
  std::map<int, std::vector<double>> poses_;  // by frame; in the order of pulls_
  bool knows_ = false;
};

HYPOTRACK_PLUGIN(Regressor, "pulls models to the poses of a regressor", "residuals jacobian")
