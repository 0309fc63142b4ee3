#include "hypotrack/clicks.hpp"

#include "hypotrack/plugin.hpp"

namespace hypotrack {
namespace {

class Clicks final : public Start {
 public:
  struct Params {
    std::filesystem::path file;
    double tolerance = 8;
    void visit(ParamVisitor& v) {
      v("file", file,
        {.help = "landmarks marked in both views (YAML: `clicks: [{landmark, left: [x, y], right: "
                 "[x, y]}, ...]`); `hypotrack start` writes it",
         .required = true});
      v("tolerance_px", tolerance,
        {.help = "distance that a click in the right view may have from the epipolar line of the "
                 "left one",
         .min = 0.1,
         .max = 1000,
         .unit = "px"});
    }
  };
  explicit Clicks(const Params& params) : params_(params) {}

  std::optional<Eigen::VectorXd> state(const StartContext& context) override {
    const std::vector<Click> clicks = read_clicks(ConfigNode::load(params_.file));
    const ClickFit fit = fit_clicks(context.scene, context.cameras, clicks, params_.tolerance,
                                    params_.file.string());
    if (context.notes) context.notes->push_back(describe(fit));
    return fit.state;
  }

 private:
  Params params_;
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::Clicks, "a fit of the models to landmarks clicked in both views", "")
