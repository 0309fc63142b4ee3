#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack {
namespace {

/// Judges by one threshold: the share of the surface whose patches agree between the views. It
/// needs no weights, and suits any model with some texture.
class AgreementJudge final : public Judge {
 public:
  // Of what searches of rendered hands, scissors and a lamp end at, 95 % of the right poses have
  // more than 0.87 of it (0.92 of the usual), and three of four wrong poses of hands less than 0.8.
  struct Params : JudgeThresholds {
    double even_at = 0.75;
    double usual_share = 0.8;
    double step = 0.05;
    void visit(ParamVisitor& v) {
      v("even_at", even_at,
        {.help = "share of agreeing patches at which a pose is as likely right as wrong, before "
                 "anything was learned",
         .min = 0,
         .max = 1});
      v("usual_share", usual_share,
        {.help = "after that: the same, as a share of the model's usual one", .min = 0, .max = 1});
      v("step", step, {.help = "more of it multiplies the odds by 2.7", .min = 0.001, .max = 1});
      JudgeThresholds::visit(v);
    }
  };

  explicit AgreementJudge(const Params& params) : Judge(params), params_(params) {}

 protected:
  double do_log_odds(const Measures& measures) const override {
    const double even = measures.experienced
                            ? params_.usual_share * measures.usual[Measures::kAgreement]
                            : params_.even_at;
    return (measures[Measures::kAgreement] - even) / params_.step;
  }

 private:
  Params params_;
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::AgreementJudge,
                 "a threshold on the share of the surface that agrees between the views", "")
