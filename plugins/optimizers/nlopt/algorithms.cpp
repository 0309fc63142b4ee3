#include "algorithms.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "hypotrack/api/error.hpp"

namespace hypotrack {
namespace {

using Bounds = NloptAlgorithm::Bounds;
using NloptPopulation = NloptAlgorithm::Population;

constexpr NloptAlgorithm with_gradient(std::string_view name, nlopt_algorithm id) {
  return {.name = name, .id = id, .uses_gradient = true};
}

constexpr std::array kAlgorithms = {
    NloptAlgorithm{"SBPLX", NLOPT_LN_SBPLX},
    NloptAlgorithm{"NELDERMEAD", NLOPT_LN_NELDERMEAD},
    NloptAlgorithm{"COBYLA", NLOPT_LN_COBYLA},
    NloptAlgorithm{"BOBYQA", NLOPT_LN_BOBYQA},
    NloptAlgorithm{"PRAXIS", NLOPT_LN_PRAXIS, Bounds::ignored},
    with_gradient("LBFGS", NLOPT_LD_LBFGS),
    with_gradient("VAR1", NLOPT_LD_VAR1),
    with_gradient("VAR2", NLOPT_LD_VAR2),
    with_gradient("TNEWTON", NLOPT_LD_TNEWTON),
    with_gradient("TNEWTON_RESTART", NLOPT_LD_TNEWTON_RESTART),
    with_gradient("TNEWTON_PRECOND", NLOPT_LD_TNEWTON_PRECOND),
    with_gradient("TNEWTON_PRECOND_RESTART", NLOPT_LD_TNEWTON_PRECOND_RESTART),
    with_gradient("SLSQP", NLOPT_LD_SLSQP),
    with_gradient("MMA", NLOPT_LD_MMA),
    with_gradient("CCSAQ", NLOPT_LD_CCSAQ),
    NloptAlgorithm{"CRS2_LM", NLOPT_GN_CRS2_LM, Bounds::finite, NloptPopulation::crs},
    NloptAlgorithm{"ESCH", NLOPT_GN_ESCH, Bounds::finite, NloptPopulation::esch},
    NloptAlgorithm{"ISRES", NLOPT_GN_ISRES, Bounds::finite, NloptPopulation::isres},
    NloptAlgorithm{"DIRECT", NLOPT_GN_DIRECT, Bounds::finite, NloptPopulation::none, true},
    NloptAlgorithm{"DIRECT_L", NLOPT_GN_DIRECT_L, Bounds::finite, NloptPopulation::none, true},
    NloptAlgorithm{"DIRECT_L_RAND", NLOPT_GN_DIRECT_L_RAND, Bounds::finite, NloptPopulation::none,
                   true},
    NloptAlgorithm{"ORIG_DIRECT_L", NLOPT_GN_ORIG_DIRECT_L, Bounds::finite, NloptPopulation::none,
                   true},
    NloptAlgorithm{"MLSL_LDS", NLOPT_G_MLSL_LDS, Bounds::finite, NloptPopulation::mlsl},
};

struct Refused {
  std::string_view name;  ///< a trailing * stands for any ending
  std::string_view reason;
};

// The first matching entry counts.
constexpr std::array kRefused = {
    Refused{
        "NEWUOA_BOUND",
        "it never returns once its arithmetic meets a number that is none (NLopt 2.7.1); BOBYQA "
        "is its successor"},
    Refused{"NEWUOA", "it knows no bounds; BOBYQA is its bounded successor"},
    Refused{"LBFGS_NOCEDAL",
            "its licence is not free; LBFGS is the free implementation of the method"},
    Refused{"STOGO*", "Debian builds NLopt without it"},
    Refused{"AUGLAG*", "it is for nonlinear constraints, and a search region has none"},
    Refused{"AGS", "it is for at most ten dimensions, and a rigid object with a hand has 34"},
    Refused{"MLSL", "its starting points are plain random ones; MLSL_LDS covers the region better"},
    Refused{"ORIG_DIRECT", "DIRECT is the same method without its limits"},
    Refused{"DIRECT_NOSCAL", "variables are scaled by the region's spread here; write DIRECT"},
    Refused{"DIRECT_L_NOSCAL", "variables are scaled by the region's spread here; write DIRECT_L"},
    Refused{"DIRECT_L_RAND_NOSCAL",
            "variables are scaled by the region's spread here; write DIRECT_L_RAND"},
    Refused{"SUBPLEX", "its licence is not free; SBPLX is the free implementation of the method"},
};

/// Removes prefixes, so that `NLOPT_LN_SBPLX` and `LN_SBPLX` mean SBPLX.
std::string_view without_prefix(std::string_view name) {
  for (const std::string_view prefix : {"NLOPT_", "LN_", "LD_", "GN_", "GD_", "G_"}) {
    if (name.starts_with(prefix)) name.remove_prefix(prefix.size());
  }
  return name;
}

bool matches(std::string_view pattern, std::string_view name) {
  if (!pattern.ends_with('*')) return pattern == name;
  return name.starts_with(pattern.substr(0, pattern.size() - 1));
}

std::string why_not(std::string_view name, std::span<const NloptAlgorithm* const> allowed) {
  const std::string_view bare = without_prefix(name);
  for (const NloptAlgorithm* algorithm : allowed) {
    if (algorithm->name == bare) return "write " + std::string(bare);
  }
  for (const Refused& refused : kRefused) {
    if (matches(refused.name, bare)) return "it is refused: " + std::string(refused.reason);
  }
  for (const NloptAlgorithm& algorithm : kAlgorithms) {
    if (algorithm.name == bare) return "it is no local algorithm that keeps to bounds";
  }
  return "there is no such algorithm";
}

const NloptAlgorithm& find(std::string_view name, std::span<const NloptAlgorithm* const> allowed,
                           const std::string& place) {
  std::string names;
  for (const NloptAlgorithm* algorithm : allowed) {
    if (algorithm->name == name) return *algorithm;
    names += (names.empty() ? "" : ", ") + std::string(algorithm->name);
  }
  throw ConfigError(place + " is '" + std::string(name) + "': " + why_not(name, allowed) +
                    "; expected one of " + names);
}

}  // namespace

const NloptAlgorithm& find_algorithm(std::string_view name, const std::string& where) {
  std::array<const NloptAlgorithm*, kAlgorithms.size()> allowed{};
  std::ranges::transform(kAlgorithms, allowed.begin(), [](const NloptAlgorithm& a) { return &a; });
  return find(name, allowed, where + ": algorithm");
}

const NloptAlgorithm& find_local_algorithm(std::string_view name, const std::string& where) {
  std::array<const NloptAlgorithm*, kAlgorithms.size()> allowed{};
  std::size_t count = 0;
  for (const NloptAlgorithm& algorithm : kAlgorithms) {
    if (algorithm.bounds == Bounds::any) allowed[count++] = &algorithm;
  }
  return find(name, std::span(allowed).first(count), where + ": local");
}

unsigned automatic_population(NloptAlgorithm::Population rule, std::int64_t dimension,
                              std::int64_t evaluations) {
  const auto between = [](std::int64_t low, std::int64_t value, std::int64_t high) {
    return static_cast<unsigned>(std::max(low, std::min(value, high)));
  };
  // Shares that did best on smooth valleys in 27 and 54 dimensions with 1,024 evaluations.
  switch (rule) {
    case NloptPopulation::crs:  // needs more than `dimension`; NLopt would take 10 (dimension + 1)
      return between(dimension + 2, evaluations / 16, 10 * (dimension + 1));
    case NloptPopulation::isres:  // NLopt would take 20 (dimension + 1)
      return between(8, evaluations / 64, 20 * (dimension + 1));
    case NloptPopulation::esch:  // NLopt would take 40
      return between(4, evaluations / 128, 40);
    case NloptPopulation::mlsl:  // samples between local searches
      return between(2, evaluations / 256, 4);
    case NloptPopulation::none:
      break;
  }
  return 0;
}

}  // namespace hypotrack
