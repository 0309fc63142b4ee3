// A plugin whose constructor throws what the scene says.
#include <array>
#include <new>
#include <stdexcept>

#include "sample_optimizer.hpp"

namespace {

enum class What { kStd, kBadAlloc, kInt, kConfigError, kDataError, kScene };

std::span<const std::string_view> enum_names(What) {
  static constexpr std::array<std::string_view, 6> kNames = {"std",          "bad_alloc",  "int",
                                                             "config_error", "data_error", "scene"};
  return kNames;
}

struct Params {
  What what = What::kStd;
  void visit(hypotrack::ParamVisitor& v) { v("what", what, {.help = "to throw"}); }
};

class Thrower : public hypotrack::test::OptimizerOfSize {
 public:
  using Params = ::Params;
  Thrower(const Params& params, hypotrack::PluginContext& context) : OptimizerOfSize(0) {
    switch (params.what) {
      case What::kStd:
        throw std::runtime_error("nothing works");
      case What::kBadAlloc:
        throw std::bad_alloc();
      case What::kInt:
        throw 42;
      case What::kConfigError:
        throw hypotrack::ConfigError(context.config().where() + ": says the plugin");
      case What::kDataError:
        throw hypotrack::DataError("file.png: says the plugin");
      case What::kScene:
        context.scene();
    }
  }
};

}  // namespace

HYPOTRACK_PLUGIN(Thrower, "throws", "")
