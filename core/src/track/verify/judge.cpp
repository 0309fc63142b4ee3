#include "hypotrack/plugin/judge.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "hypotrack/api/error.hpp"
#include "plugin/plugin_call.hpp"

namespace hypotrack {

std::span<const MeasureInfo, Measures::kCount> measure_infos() {
  static constexpr std::array<MeasureInfo, Measures::kCount> kInfos{{
      {"correlation", "-1 to 1", "correlation of the two views' colours over the surface"},
      {"texture", "-1 to 1", "correlation after subtraction of the mean of each patch"},
      {"agreement", "0 to 1", "share of the surface whose patches correlate by more than half"},
      {"contrast", "-1 to 2.2", "log10 of the standard deviation of colours within patches"},
      {"difference", "-1 to 2.7", "log10 of the median distance of the two views' colours"},
      {"ring_texture", "-1 to 1", "texture of the ring: high where the background is as near"},
      {"ring_difference", "-1 to 2.7", "difference of the ring"},
      {"separation", "0 to 1",
       "total variation distance of the colour histograms inside and in the ring"},
      {"edges", "0 to 1", "share of the silhouette where colours change by more than 20"},
      {"edge_ratio", "-2 to 2",
       "log10 of the change of colour across the silhouette over changes on either side"},
      {"inside", "0 to 1", "mean foreground probability of the surface; 0.5: nothing was learned"},
      {"ring", "0 to 1", "mean foreground probability of the ring"},
      {"paired", "0 to 1", "share of the surface that both views show"},
      {"visible", "0 to 1", "share of the model's vertices inside both pictures"},
      {"worst_agreement", "0 to 1", "agreement of the worst pieces of the surface"},
      {"worst_inside", "0 to 1", "inside of the worst pieces of the surface"},
      {"worst_ring", "0 to 1", "ring of the worst pieces of the ring"},
      {"worst_edges", "0 to 1", "edges of the worst of eight sectors of the silhouette"},
  }};
  return kInfos;
}

Judge::~Judge() = default;

double Judge::log_odds(const Measures& measures) const {
  const double out = detail::call_plugin(*this, [&] { return do_log_odds(measures); });
  if (!std::isnan(out)) return out;
  throw PluginError(fmt::format(
      "{}: the log odds of a pose are NaN, expected a number or an infinity; this is a bug in the "
      "judge",
      detail::label_or(*this, "the judge")));
}

FittedJudge Judge::fit(const JudgeFit& to) const {
  return detail::call_plugin(*this, [&] { return do_fit(to); });
}

FittedJudge Judge::do_fit(const JudgeFit&) const {
  throw PluginError("it has nothing to fit; `hypotrack plugins list` has other judges");
}

double probability_of(double log_odds) { return 1 / (1 + std::exp(-log_odds)); }

}  // namespace hypotrack
