#include "pso_cuda.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "hypotrack/api/stop.hpp"
#include "hypotrack/gpu/device_cost.hpp"
#include "hypotrack/gpu/work_graph.cuh"
#include "hypotrack/plugin/search.hpp"
#include "swarm.hpp"
#include "swarm_memory.hpp"

namespace hypotrack {
namespace {

using cuda::DeviceCost;
using cuda::Stream;
using cuda::SwarmLayout;

// Limits of a search that is enqueued at once and cannot be interrupted: generations, which a
// graph's memory grows with, and evaluations.
constexpr std::int64_t kMostCaptured = 1024, kMostUninterrupted = 1 << 16;

/// Generations of `particles` evaluations; the last one may be partial.
struct Schedule {
  std::int64_t particles;
  std::int64_t evaluations;

  std::int64_t generations() const { return (evaluations + particles - 1) / particles; }
  std::int64_t count(std::int64_t generation) const {
    return std::min(particles, evaluations - generation * particles);
  }
  /// Returns whether the search is short enough to be enqueued at once.
  bool at_once() const {
    return generations() <= kMostCaptured && evaluations <= kMostUninterrupted;
  }
  /// Returns whether the last generation is complete.
  bool whole() const { return evaluations % particles == 0; }
  bool operator==(const Schedule&) const = default;
};

/// Everything that a captured search depends on.
struct CapturedFor {
  const DeviceCost* cost;
  void* stream;
  std::uint64_t revision;
  Schedule schedule;
  SwarmLayout swarm;
  bool operator==(const CapturedFor&) const = default;
};

/// A search on the stream of a cost.
class Search {
 public:
  Search(DeviceCost& cost, const SwarmLayout& swarm, const Schedule& schedule,
         const cuda::SwarmSettings& how, const StartDistribution& starts)
      : cost_(cost),
        stream_(cost.stream()),
        swarm_(swarm),
        schedule_(schedule),
        how_(how),
        starts_(starts) {}

  CapturedFor captured_for() const {
    return {&cost_, stream_.handle, cost_.revision(), schedule_, swarm_};
  }
  Stream stream() const { return stream_; }
  std::int64_t generations() const { return schedule_.generations(); }
  std::int64_t particles() const { return schedule_.particles; }

  /// Enqueues all generations, or until `enough()` returns true between two. Returns their number.
  template <class Enough>
  std::int64_t enqueue(int most_blocks, const Enough& enough) {
    cuda::enqueue_region(swarm_, stream_);
    std::int64_t generation = 0;
    do {
      enqueue_generation(most_blocks, generation++);
    } while (generation < generations() && !enough());
    cuda::enqueue_answer(swarm_, generation - 1, schedule_.count(generation - 1), stream_);
    return generation;
  }

 private:
  void enqueue_generation(int most_blocks, std::int64_t generation) {
    if (generation == 0) {
      cuda::enqueue_initial(swarm_, most_blocks, starts_, stream_);
    } else {
      cuda::enqueue_move(swarm_, most_blocks, how_, generation, stream_);
    }
    cost_.enqueue(swarm_.generation(generation).position, schedule_.count(generation),
                  swarm_.costs);
  }

  DeviceCost& cost_;
  Stream stream_;
  SwarmLayout swarm_;
  Schedule schedule_;
  cuda::SwarmSettings how_;
  StartDistribution starts_;
};

void wait_for(Stream stream) {
  cuda::check(cudaStreamSynchronize(cuda::native(stream)), "a search of pso_cuda");
}

/// Runs a search without a graph, until the deadline if there is one. Waits for the GPU now and
/// then, so that the search can be ended.
std::int64_t run_directly(Search& search, const Deadline* deadline) {
  try {
    std::int64_t enqueued = 0;  // evaluations since the last wait
    return search.enqueue(cuda::most_blocks(), [&] {
      check_stop();
      enqueued += search.particles();
      if (!deadline && enqueued < kMostUninterrupted) return false;
      enqueued = 0;
      wait_for(search.stream());
      return deadline && deadline->passed();
    });
  } catch (...) {
    (void)cudaStreamSynchronize(cuda::native(search.stream()));  // before the memory is used again
    throw;
  }
}

}  // namespace

struct PsoCuda::OnDevice {
  cuda::SwarmMemory memory;
  cuda::WorkGraph graph;
  std::optional<CapturedFor> captured;

  /// Enqueues the search as one kernel. Returns false if that is impossible.
  bool enqueue_as_one(DeviceCost& cost, const SwarmLayout& swarm, const Schedule& schedule,
                      const cuda::SwarmSettings& how, const StartDistribution& start,
                      const SearchRegion& region, std::uint64_t seed) {
    if (!schedule.whole() || !schedule.at_once()) return false;
    if (swarm.dimension > cuda::kMostSwarmDimensions) return false;
    cuda::SwarmSearch search = memory.search(swarm, schedule.generations(), region, seed);
    search.constriction = how.constriction;
    search.reset = how.reset;
    search.start = start;
    return cost.enqueue_search(search);
  }

  void run_captured(Search& search) {
    if (const CapturedFor wanted = search.captured_for(); captured != wanted) {
      captured.reset();
      const int most_blocks = cuda::most_blocks();
      graph.capture(search.stream(), [&] { search.enqueue(most_blocks, [] { return false; }); });
      captured = wanted;
    }
    graph.launch(search.stream());
  }
};

PsoCuda::PsoCuda(const PsoParams& params, const std::string& where)
    : params_(params),
      constriction_(make_constriction(params.cognitive, params.social, where)),
      where_(where),
      on_device_(std::make_unique<OnDevice>()) {}

PsoCuda::~PsoCuda() = default;

std::int64_t PsoCuda::default_evaluations() const {
  return std::int64_t{params_.particles} * params_.generations;
}

Requirements PsoCuda::requirements() const {
  return {.device = true,
          .device_by = where_ + ": pso_cuda",
          .instead_of_device = "`type: pso`, the same search on the CPU"};
}

OptimizerResult PsoCuda::minimize(CostFunction& cost, const SearchRegion& region,
                                  const Budget& budget, std::uint64_t seed) {
  check_search(cost, region, budget);
  const Deadline deadline(budget.seconds);
  DeviceCost* device = cost.device();
  check_requirements(requirements(), nullptr, device);
  const Schedule schedule{std::min<std::int64_t>(params_.particles, budget.evaluations),
                          budget.evaluations};
  device->reserve(schedule.particles);
  const SwarmLayout swarm = on_device_->memory.reserve(schedule.particles, cost.dimension());
  const bool timed = std::isfinite(budget.seconds);
  std::int64_t generations = schedule.generations();
  const cuda::SwarmSettings how{constriction_, params_.reset, params_.start.sigma};
  if (timed ||
      !on_device_->enqueue_as_one(*device, swarm, schedule, how, params_.start, region, seed)) {
    on_device_->memory.write(region, seed);
    Search search(*device, swarm, schedule, how, params_.start);
    if (timed || !schedule.at_once()) {
      generations = run_directly(search, timed ? &deadline : nullptr);
    } else {
      on_device_->run_captured(search);
    }
  }
  wait_for(device->stream());
  OptimizerResult result = on_device_->memory.answer(cost.dimension());
  result.evaluations = std::min(generations * schedule.particles, schedule.evaluations);
  return result;
}

}  // namespace hypotrack
