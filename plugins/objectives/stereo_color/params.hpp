#pragma once

#include <span>
#include <string_view>

#include "hypotrack/plugin/params.hpp"
#include "settings.hpp"

namespace hypotrack::stereo_color {

std::span<const std::string_view> enum_names(ColorSpace);
std::span<const std::string_view> enum_names(Distinctiveness);
std::span<const std::string_view> enum_names(Aggregation);
std::span<const std::string_view> enum_names(Direction);
std::span<const std::string_view> enum_names(Falloff);
std::span<const std::string_view> enum_names(Lookup);

/// Parameters of `type: stereo_color`; the defaults are the paper's.
struct Params : Settings {
  void visit(ParamVisitor& v) {
    v("beta", beta,
      {.help = "how fast similarity falls with colour distance (colours in 0..1)",
       .min = 0,
       .max = 1e4});
    v("beta_by_difference", beta_by_difference,
      {.help = "if not 0, beta is this over the median colour difference of the two views at the "
               "last solutions, once photometric.match has found that",
       .min = 0,
       .max = 100});
    v("beta_min", beta_min, {.help = "least beta by difference", .min = 0, .max = 1e4});
    v("beta_max", beta_max, {.help = "greatest beta by difference", .min = 0, .max = 1e4});
    v("falloff", falloff,
      {.help = "similarity at a colour distance d: the paper's exp(-beta d), or exp(-(beta d)^2), "
               "which keeps colours alike that differ by no more than noise"});
    v("coverage_penalty", coverage_penalty,
      {.help = "least similarity at which covering a pixel pays: a pixel counts by its similarity "
               "minus this",
       .min = 0,
       .max = 1});
    v("gray_weight", gray_weight,
      {.help = "weight of the part of a colour difference that all channels share; highlights have "
               "it, and each camera sees them elsewhere. Below 1 with color_space: rgb only",
       .min = 0,
       .max = 1});
    v("w_t", w_t, {.help = "distinctiveness below this counts as none", .min = 0, .max = 1});
    v("r_mm", r,
      {.help = "a surface point is seen in both views if the depths rendered there agree this well",
       .min = 1e-3,
       .max = 1e3,
       .unit = "mm",
       .to_si = kMillimetre});
    v("color_space", color_space,
      {.help = "space in which colours are compared; every channel is scaled to 0..1"});
    v("distinctiveness", distinctiveness,
      {.help = "weight of a pixel: the paper's measure, or none: all 1 (slides onto uniform "
               "surfaces in real images)"});
    v("aggregation", aggregation,
      {.help = "how similarities S become one score: S, S / pixels seen in both views, S / pixels "
               "rendered, S / sqrt(pixels rendered)"});
    v("direction", direction,
      {.help = "view whose pixels are summed; both: the mean of the two scores"});
    v("lookup", lookup, {.help = "how the other view's colour is read"});
    v("use_mask", use_mask,
      {.help = "pixels outside the frame's foreground mask, where it has one, weigh nothing"});
  }
};

}  // namespace hypotrack::stereo_color
