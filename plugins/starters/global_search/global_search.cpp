#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack {
namespace {

class Global final : public Starter {
 public:
  struct Params {
    GlobalSearchSettings settings;
    void visit(ParamVisitor& v) {
      v("hypotheses", settings.hypotheses,
        {.help = "poses evaluated per place; 0: as recovery says, and six times that for "
                 "a model that was never seen",
         .min = 0,
         .max = 1e6});
      v("refined", settings.refined,
        {.help = "best of them refined by least squares; 0: as recovery says, and six "
                 "times that for a model that was never seen",
         .min = 0,
         .max = 1e4});
      v("searched", settings.searched,
        {.help = "best of those searched by the scene's optimizer; 0: as recovery says, "
                 "and twice that for a model that was never seen",
         .min = 0,
         .max = 100});
    }
  };
  explicit Global(const Params& params) : params_(params) {}

 private:
  bool do_looks() const override { return true; }

  void do_find(const StarterContext& context, std::size_t /*model*/,
               const TakePose& take) override {
    if (context.search) context.search->find(params_.settings, take);
  }

  Params params_;
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::Global, "a search of the whole pictures with the scene's objective", "")
