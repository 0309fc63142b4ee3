#include <fmt/format.h>
#include <nlopt.h>

#include <cmath>
#include <memory>
#include <string>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/random.hpp"
#include "weights.hpp"

namespace hypotrack {
namespace {

constexpr Eigen::Index kHidden = 32;
constexpr double kPenalty = 0.0015;  // of the squared weights, for inputs of variance 1
constexpr int kMostSteps = 600;
constexpr double kSettled = 1e-6;  // relative change of the loss that ends the fit

using Hidden = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A network's numbers in one vector: the units' weights, their biases, the weights of their
/// answers, the bias.
template <class Number>
struct Parts {
  Parts(Number* all, Eigen::Index inputs)
      : hidden(all, kHidden, inputs),
        bias(all + kHidden * inputs, kHidden),
        out(all + kHidden * (inputs + 1), kHidden),
        out_bias(all[kHidden * (inputs + 2)]) {}

  template <class Type>
  using Of = Eigen::Map<std::conditional_t<std::is_const_v<Number>, const Type, Type>>;
  Of<Hidden> hidden;
  Of<Eigen::VectorXd> bias, out;
  Number& out_bias;
};

Eigen::Index number_count(Eigen::Index inputs) { return kHidden * (inputs + 2) + 1; }

/// The rows with inputs of mean 0 and variance 1.
struct Standardized {
  Eigen::RowVectorXd mean, scale;  ///< scale 0: the same in all rows
  Eigen::MatrixXd inputs;
  Eigen::VectorXd right, share;  ///< of each row in the loss

  explicit Standardized(const FitRows& rows)
      : mean(rows.inputs.colwise().mean()),
        right(rows.right),
        share(rows.weights / rows.weights.sum()) {
    constexpr double kSame = 1e-9;
    inputs = rows.inputs.rowwise() - mean;
    scale = (inputs.colwise().squaredNorm() / static_cast<double>(inputs.rows())).cwiseSqrt();
    scale = (scale.array() > kSame).select(scale.cwiseInverse(), 0);
    inputs.array().rowwise() *= scale.array();
  }

  /// Returns the mean negative log likelihood with the penalty, and its gradient.
  double loss(const double* numbers, double* gradient) const {
    const Parts<const double> at(numbers, inputs.cols());
    const Eigen::MatrixXd sums = (inputs * at.hidden.transpose()).rowwise() + at.bias.transpose();
    const Eigen::MatrixXd units = sums.cwiseMax(0);
    const Eigen::ArrayXd odds = (units * at.out).array() + at.out_bias;
    // log(1 + exp(odds)) without overflow
    const Eigen::ArrayXd certain = odds.cwiseMax(0) + (-odds.abs()).exp().log1p();
    const double penalty = kPenalty / 2 * (at.hidden.squaredNorm() + at.out.squaredNorm());
    const double out = (share.array() * (certain - right.array() * odds)).sum() + penalty;
    if (!gradient) return out;
    const Eigen::VectorXd error = share.array() * (1 / (1 + (-odds).exp()) - right.array());
    Parts<double> slope(gradient, inputs.cols());
    const Eigen::MatrixXd of_units =
        (error * at.out.transpose()).cwiseProduct((sums.array() > 0).cast<double>().matrix());
    slope.hidden = of_units.transpose() * inputs + kPenalty * at.hidden;
    slope.bias = of_units.colwise().sum().transpose();
    slope.out = units.transpose() * error + kPenalty * at.out;
    slope.out_bias = error.sum();
    return out;
  }
};

double loss_of(unsigned, const double* numbers, double* gradient, void* rows) {
  return static_cast<const Standardized*>(rows)->loss(numbers, gradient);
}

/// Returns small random weights (Glorot and Bengio, AISTATS 2010).
Eigen::VectorXd first_numbers(Eigen::Index inputs) {
  Eigen::VectorXd out(number_count(inputs));
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    const bool is_hidden = i < kHidden * inputs;
    const double reach =
        std::sqrt(6.0 / static_cast<double>(is_hidden ? inputs + kHidden : kHidden + 1));
    out[i] = reach * (2 * uniform4(1, {static_cast<std::uint32_t>(i)})[0] - 1);
  }
  return out;
}

/// Rounds to five digits, which files have.
double rounded(double value) { return std::stod(fmt::format("{:.5g}", value)); }

/// Returns a network for inputs as they are.
Network unscaled(const Eigen::VectorXd& numbers, const Standardized& rows) {
  const Eigen::Index inputs = rows.inputs.cols();
  const Parts<const double> parts(numbers.data(), inputs);
  Network out;
  out.bias = rounded(parts.out_bias);
  for (Eigen::Index unit = 0; unit < kHidden; ++unit) {
    const Eigen::RowVectorXd in = parts.hidden.row(unit).cwiseProduct(rows.scale);
    NetworkUnit& to = out.units.emplace_back();
    to.bias = rounded(parts.bias[unit] - in.dot(rows.mean));
    to.out = rounded(parts.out[unit]);
    for (const double weight : in) to.in.push_back(rounded(weight));
  }
  return out;
}

}  // namespace

Network fit_network(const FitRows& rows) {
  Standardized standardized(rows);
  const Eigen::Index inputs = rows.inputs.cols();
  Eigen::VectorXd numbers = first_numbers(inputs);
  const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> opt(
      nlopt_create(NLOPT_LD_LBFGS, static_cast<unsigned>(numbers.size())), &nlopt_destroy);
  nlopt_set_min_objective(opt.get(), &loss_of, &standardized);
  nlopt_set_maxeval(opt.get(), kMostSteps);
  nlopt_set_ftol_rel(opt.get(), kSettled);
  double loss = 0;
  const nlopt_result result = nlopt_optimize(opt.get(), numbers.data(), &loss);
  if (result < 0 && result != NLOPT_ROUNDOFF_LIMITED)
    throw Error(fmt::format("the fit of the network failed: {}", nlopt_result_to_string(result)));
  return unscaled(numbers, standardized);
}

}  // namespace hypotrack
