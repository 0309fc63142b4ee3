#include "weights.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "hypotrack/api/config.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/text.hpp"

namespace hypotrack {
namespace {

[[noreturn]] void fail_at(const ConfigNode& node, std::string_view problem) {
  throw ConfigError(fmt::format("{}: {}: {}", node.where(), node.path(), problem));
}

/// The version, which says how to read the rest of the file.
struct VersionOnly {
  int version = 0;
  void visit(ParamVisitor& v) {
    v("version", version, {.help = "of the measures", .required = true});
  }
};

void expect_version(const ConfigNode& root) {
  const int found = ParamReader(root, root.keys()).read<VersionOnly>().version;
  if (found == kMeasuresVersion) return;
  fail_at(root.get("version"),
          fmt::format("found weights for version {} of the measures, expected {}; take the weights "
                      "that come with this hypotrack, or fit others with it",
                      found, kMeasuresVersion));
}

std::vector<Measures::Index> inputs_of(const ConfigNode& root, const NetworkWeights& weights) {
  std::vector<std::string> known;
  for (const MeasureInfo& info : measure_infos()) known.emplace_back(info.name);
  std::vector<Measures::Index> out;
  for (std::size_t i = 0; i < weights.measures.size(); ++i) {
    const std::string& name = weights.measures[i];
    const auto at = std::ranges::find(known, name);
    const ConfigNode node = root.get("measures").at(i);
    if (at == known.end()) {
      const std::string meant = did_you_mean(name, known);
      fail_at(node, fmt::format("there is no measure '{}'{} {}", name,
                                meant.empty() ? "; there are:" : meant + " There are:",
                                fmt::join(known, ", ")));
    }
    const auto index = static_cast<Measures::Index>(at - known.begin());
    if (std::ranges::find(out, index) != out.end())
      fail_at(node, fmt::format("the measure '{}' stands there twice", name));
    out.push_back(index);
  }
  return out;
}

void check_sizes(const ConfigNode& network, const Network& read, std::size_t measures) {
  const ConfigNode units = network.get("units");
  if (measures == 0) fail_at(network, "has no measures, expected one or more in `measures`");
  if (read.units.empty()) fail_at(network, "has no units, expected one or more");
  if (!std::isfinite(read.bias)) fail_at(network.get("bias"), "expected a finite number");
  for (std::size_t i = 0; i < read.units.size(); ++i) {
    const NetworkUnit& unit = read.units[i];
    if (!std::isfinite(unit.bias) || !std::isfinite(unit.out) ||
        !std::ranges::all_of(unit.in, [](double weight) { return std::isfinite(weight); }))
      fail_at(units.at(i), "has a number that is not finite");
    if (unit.in.size() != 2 * measures)
      fail_at(units.at(i).get("in"),
              fmt::format("has {} weights, expected {}: two for each of {} measures",
                          unit.in.size(), 2 * measures, measures));
  }
}

}  // namespace

void NetworkUnit::visit(ParamVisitor& v) {
  v("bias", bias, {.help = "added to the weighted sum", .required = true});
  v("out", out, {.help = "weight of the unit's answer", .required = true});
  v("in", in,
    {.help = "weights of the measures, then of their differences from the usual ones",
     .required = true});
}

void Network::visit(ParamVisitor& v) {
  v("bias", bias, {.help = "added to the sum of the units", .required = true});
  v("units", units, {.help = "rectified linear units", .required = true});
}

void NetworkWeights::visit(ParamVisitor& v) {
  v("version", version, {.help = "of the measures", .required = true});
  v("fitted_to", fitted_to, {.help = "types of models", .required = true});
  v("trained_on", trained_on, {.help = "frames and poses", .required = true});
  v("measures", measures, {.help = "names, in the order of the weights", .required = true});
  v("likeness", likeness,
    {.help = "weight of the usual likeness times the difference from it", .required = true});
  v("fresh", fresh, {.help = "before anything was learned", .required = true});
  v("experienced", experienced, {.help = "after that", .required = true});
}

LoadedWeights load_weights(const std::filesystem::path& file) {
  const ConfigNode root = ConfigNode::load(file);
  expect_version(root);
  LoadedWeights out{ParamReader(root).read<NetworkWeights>(), {}};
  out.inputs = inputs_of(root, out.weights);
  check_sizes(root.get("fresh"), out.weights.fresh, out.inputs.size());
  check_sizes(root.get("experienced"), out.weights.experienced, out.inputs.size());
  return out;
}

}  // namespace hypotrack
