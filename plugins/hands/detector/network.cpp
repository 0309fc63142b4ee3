#include "network.hpp"

#include <algorithm>
#include <map>
#include <mutex>
#include <new>
#include <unordered_map>

#include "hypotrack/api/stop.hpp"
#include "network_file.hpp"
#include "network_plan.hpp"

namespace hypotrack::hands {

/// What one thread needs to run a plan.
class Network::Context {
 public:
  /// The plan outlives it.
  explicit Context(const NetworkPlan& plan)
      : plan_(plan), memory_(plan.size), stream_(plan.engine) {
    std::vector<dnnl::memory> buffers;
    for (const PlanBuffer& buffer : plan.buffers) {
      buffers.push_back(buffer.constant
                            ? buffer.constant
                            : dnnl::memory(buffer.desc, plan.engine, memory_.at(buffer.offset)));
    }
    for (const PlanOperation& operation : plan.operations) {
      auto& arguments = arguments_.emplace_back();
      for (const auto& [kind, buffer] : operation.arguments)
        arguments.emplace(kind, buffers[buffer]);
    }
  }

  void run(const Network::WritePicture& write) {
    write(numbers(0));
    for (std::size_t i = 0; i < arguments_.size(); ++i)
      plan_.operations[i].primitive.execute(stream_, arguments_[i]);
    stream_.wait();
  }

  std::vector<std::vector<float>> outputs() const {
    std::vector<std::vector<float>> out;
    for (const std::vector<std::size_t>& buffers : plan_.outputs) {
      std::vector<float>& values = out.emplace_back();
      for (const std::size_t buffer : buffers) {
        const std::span<float> part = numbers(buffer);
        values.insert(values.end(), part.begin(), part.end());
      }
    }
    return out;
  }

 private:
  /// Zeros that begin at a cache line.
  class Memory {
   public:
    explicit Memory(std::size_t size)
        : data_(static_cast<std::byte*>(::operator new(size, kAlignment))) {
      std::fill_n(data_.get(), size, std::byte{});
    }
    std::byte* at(std::size_t offset) const { return data_.get() + offset; }

   private:
    static constexpr std::align_val_t kAlignment{64};
    struct Free {
      void operator()(std::byte* data) const { ::operator delete(data, kAlignment); }
    };
    std::unique_ptr<std::byte, Free> data_;
  };

  std::span<float> numbers(std::size_t buffer) const {
    const PlanBuffer& b = plan_.buffers[buffer];
    return {reinterpret_cast<float*>(memory_.at(b.offset)), b.desc.get_size() / sizeof(float)};
  }

  const NetworkPlan& plan_;
  Memory memory_;
  dnnl::stream stream_;
  std::vector<std::unordered_map<int, dnnl::memory>> arguments_;  // by operation
};

namespace {

/// A file as it was at some time.
struct FileState {
  std::filesystem::path path;
  std::uintmax_t size = 0;
  std::filesystem::file_time_type written;
  auto operator<=>(const FileState&) const = default;
};

FileState state_of(const std::filesystem::path& file) {
  std::error_code missing;  // which reading the file tells
  FileState out{std::filesystem::weakly_canonical(file, missing), 0, {}};
  out.size = std::filesystem::file_size(file, missing);
  out.written = std::filesystem::last_write_time(file, missing);
  return out;
}

}  // namespace

/// A network of a file, its plans and the contexts that no thread uses at the moment.
struct Network::Shared {
  explicit Shared(const std::filesystem::path& from) : file(from), graph(read_network(from)) {
    add_team(graph, 1);
    graph.weights = {};  // the plans have them in the order of the primitives
  }

  /// A plan for a number of threads.
  struct Team {
    NetworkPlan plan;
    std::vector<std::unique_ptr<Context>> idle;  // as many as ran it at the same time
  };

  /// Returns the plan for a number of threads. The first call for each reads the weights again.
  Team& team(int threads) {
    const std::lock_guard lock(mutex);
    const auto known = teams.find(threads);
    return known != teams.end() ? known->second : add_team(read_network(file), threads);
  }

  std::unique_ptr<Context> take(Team& team) {
    {
      const std::lock_guard lock(mutex);
      if (!team.idle.empty()) {
        std::unique_ptr<Context> out = std::move(team.idle.back());
        team.idle.pop_back();
        return out;
      }
    }
    return std::make_unique<Context>(team.plan);
  }

  void give_back(Team& team, std::unique_ptr<Context> context) {
    const std::lock_guard lock(mutex);
    team.idle.push_back(std::move(context));
  }

  std::filesystem::path file;
  NetworkGraph graph;  ///< without weights

 private:
  Team& add_team(const NetworkGraph& weighted, int threads) {
    try {
      return teams.emplace(threads, Team{plan_network(weighted, threads), {}}).first->second;
    } catch (const dnnl::error& error) {
      fail_damaged(file, error.what());
    }
  }

  std::mutex mutex;
  std::map<int, Team> teams;  // by threads
};

std::shared_ptr<Network::Shared> Network::shared(const std::filesystem::path& file) {
  static std::mutex mutex;
  static std::map<FileState, std::weak_ptr<Shared>> known;
  const std::lock_guard lock(mutex);
  std::erase_if(known, [](const auto& entry) { return entry.second.expired(); });
  std::weak_ptr<Shared>& entry = known[state_of(file)];
  std::shared_ptr<Shared> out = entry.lock();
  if (!out) {
    out = std::make_shared<Shared>(file);
    entry = out;
  }
  return out;
}

Network::Network(const std::filesystem::path& file, int side,
                 const std::vector<ExpectedOutput>& outputs)
    : side_(side), shared_(shared(file)) {
  const NetworkGraph& graph = shared_->graph;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (i >= graph.outputs.size() || graph.outputs[i].name != outputs[i].name)
      fail_damaged(file, "it has no output " + outputs[i].name);
    if (graph.size(graph.outputs[i]) != outputs[i].size)
      fail_damaged(file, "its output " + outputs[i].name + " has another size");
  }
  if (graph.outputs.size() != outputs.size()) fail_damaged(file, "it has other outputs");
  if (graph.tensors.front() != TensorShape{side, side, 3})
    fail_damaged(file, "it takes pictures of another size");
}

std::vector<std::vector<float>> Network::run(const WritePicture& write, int threads) const {
  check_stop();
  Shared::Team& team = shared_->team(threads);
  try {
    const OmpThreads own_threads(threads);
    std::unique_ptr<Context> context = shared_->take(team);
    context->run(write);
    std::vector<std::vector<float>> out = context->outputs();
    shared_->give_back(team, std::move(context));
    return out;
  } catch (const dnnl::error& error) {
    fail_damaged(shared_->file, error.what());
  }
}

}  // namespace hypotrack::hands
