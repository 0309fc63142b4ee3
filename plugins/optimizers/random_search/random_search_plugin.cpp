#include "hypotrack/plugin/plugin.hpp"
#include "random_search.hpp"

namespace {

class RandomSearchPlugin final : public hypotrack::RandomSearch {
 public:
  using Params = hypotrack::RandomSearchParams;
  using RandomSearch::RandomSearch;
};

}  // namespace

HYPOTRACK_PLUGIN(RandomSearchPlugin, "normal samples about the start: the baseline",
                 "batches seeded")
