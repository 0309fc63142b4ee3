#include "cma_es.hpp"
#include "hypotrack/plugin/plugin.hpp"

namespace {

class CmaEsPlugin final : public hypotrack::CmaEs {
 public:
  using Params = hypotrack::CmaEsParams;
  using CmaEs::CmaEs;
};

}  // namespace

HYPOTRACK_PLUGIN(CmaEsPlugin, "CMA-ES (Hansen and Ostermeier 2001) of pagmo", "batches seeded")
