#include "hypotrack/api/clicks.hpp"

#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack {
namespace {

class Clicks final : public Starter {
 public:
  struct Params {
    std::filesystem::path file;
    double tolerance = 8;
    void visit(ParamVisitor& v) {
      v("file", file,
        {.help = "landmarks marked in both views (YAML: `clicks: [{landmark, left: [x, y], right: "
                 "[x, y]}, ...]`); `hypotrack click` writes it, with the frame that they belong to",
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

 private:
  std::optional<Eigen::VectorXd> do_state(const StarterContext& context) override {
    const ClickedFrame clicked = read_clicks(ConfigNode::load(params_.file));
    const std::string where = params_.file.string();
    if (!clicked.pictures.empty() && !context.frame) return std::nullopt;
    if (context.frame) expect_clicked_frame(clicked, *context.frame, where);
    const ClickFit fit =
        fit_clicks(context.scene, context.cameras, clicked.clicks, params_.tolerance, where);
    if (context.notes) context.notes->push_back(describe(fit));
    return fit.state;
  }

  Params params_;
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::Clicks, "a fit of the models to landmarks clicked in both views", "")
