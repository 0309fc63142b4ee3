#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "hypotrack/plugin/judge.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack {

/// A rectified linear unit of the hidden layer.
struct NetworkUnit {
  double bias = 0;
  double out = 0;          ///< weight of its answer
  std::vector<double> in;  ///< of the measures, then of their differences from the usual ones
  void visit(ParamVisitor& v);
};

/// One hidden layer; the answer is the logarithm of the odds.
struct Network {
  double bias = 0;
  std::vector<NetworkUnit> units;
  void visit(ParamVisitor& v);
};

/// What a file of weights holds.
struct NetworkWeights {
  int version = 0;                     ///< of the measures
  std::vector<std::string> fitted_to;  ///< types of models
  std::string trained_on;
  std::vector<std::string> measures;  ///< names, in the order of the weights
  double likeness = 0;                ///< weight of the usual likeness times the difference from it
  Network fresh;                      ///< before anything was learned
  Network experienced;                ///< after that
  void visit(ParamVisitor& v);
};

/// Poses to fit a network to, a row each.
struct FitRows {
  Eigen::MatrixXd inputs;
  Eigen::VectorXd right;    ///< 1: the pose is right; 0: it is wrong
  Eigen::VectorXd weights;  ///< of the rows
};

/// Fits a network by maximum likelihood with a penalty on its squared weights (L-BFGS; Nocedal
/// 1980). Inputs that are the same in all rows get no weight. Equal rows give equal networks.
Network fit_network(const FitRows& rows);

/// Weights, and where each of their measures stands in Measures.
struct LoadedWeights {
  NetworkWeights weights;
  std::vector<Measures::Index> inputs;
};

/// Reads a file of weights. Throws ConfigError with file and line if it is of another version,
/// names an unknown measure, or has another number of weights than measures.
LoadedWeights load_weights(const std::filesystem::path& file);

}  // namespace hypotrack
