#include <cuda_runtime.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <iterator>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "block.hpp"
#include "blocks.hpp"

using Work = std::vector<std::function<void()>>;

struct CUstream_st {
  bool captures = false;
  Work captured;
  cudaStream_t joins = nullptr;  ///< the stream whose capture has its work, while that captures
};
struct CUevent_st {
  cudaStream_t recorded_in = nullptr;
};
struct CUgraph_st {
  Work work;
};
struct CUgraphExec_st {
  Work work;
};

namespace {

constexpr std::size_t kMemory = std::size_t{4} << 30;  // of the device, bytes
constexpr std::size_t kAlignment = 256;

std::atomic<cudaError_t> of_kernel = cudaSuccess;  // stays
thread_local cudaError_t last = cudaSuccess;

cudaError_t result(cudaError_t error) {
  if (of_kernel != cudaSuccess) error = of_kernel;
  if (error != cudaSuccess) last = error;
  return error;
}

struct Description {
  cudaError_t error;
  const char* name;
  const char* text;
};
constexpr Description kDescriptions[] = {
    {cudaSuccess, "cudaSuccess", "no error"},
    {cudaErrorInvalidValue, "cudaErrorInvalidValue", "invalid argument"},
    {cudaErrorMemoryAllocation, "cudaErrorMemoryAllocation", "out of memory"},
    {cudaErrorInvalidDevice, "cudaErrorInvalidDevice", "invalid device ordinal"},
    {cudaErrorLaunchFailure, "cudaErrorLaunchFailure", "unspecified launch failure"},
    {cudaErrorCooperativeLaunchTooLarge, "cudaErrorCooperativeLaunchTooLarge",
     "too many blocks in cooperative launch"},
    {cudaErrorNotSupported, "cudaErrorNotSupported", "operation not supported"},
    {cudaErrorStreamCaptureUnsupported, "cudaErrorStreamCaptureUnsupported",
     "operation not permitted when stream is capturing"}};

const Description& description(cudaError_t error) {
  static constexpr Description kUnknown = {cudaSuccess, "unknown", "unknown error"};
  const auto* found = std::find_if(std::begin(kDescriptions), std::end(kDescriptions),
                                   [&](const Description& d) { return d.error == error; });
  return found != std::end(kDescriptions) ? *found : kUnknown;
}

/// A fault on purpose, which the environment asks for: CUDA_ON_CPU_FAULT=NAME:N.
class Fault {
 public:
  explicit Fault(const char* name) {
    const char* wanted = std::getenv("CUDA_ON_CPU_FAULT");
    const std::size_t length = std::strlen(name);
    if (wanted != nullptr && std::strncmp(wanted, name, length) == 0 && wanted[length] == ':')
      first_ = std::atol(wanted + length + 1);
  }
  /// Counts the calls of this function from 0. Returns true from the N-th on.
  bool is_due() { return first_ >= 0 && calls_++ >= first_; }

 private:
  long first_ = -1;
  std::atomic<long> calls_ = 0;
};

/// Every allocation, whether the device's own or page-locked.
class Memory {
 public:
  cudaError_t reserve(void** memory, std::size_t bytes, cudaMemoryType type) {
    if (of_kernel != cudaSuccess) return result(of_kernel);
    static Fault full("memory");
    const std::lock_guard<std::mutex> lock(mutex_);
    if (type == cudaMemoryTypeDevice && (full.is_due() || bytes > kMemory - used_)) {
      return result(cudaErrorMemoryAllocation);
    }
    const std::size_t room = (bytes + kAlignment - 1) / kAlignment * kAlignment;
    *memory = std::aligned_alloc(kAlignment, room);
    if (*memory == nullptr) return result(cudaErrorMemoryAllocation);
    std::memset(*memory, 0xA5, room);  // nobody may rely on zeros
    blocks_[*memory] = {bytes, type};
    if (type == cudaMemoryTypeDevice) used_ += bytes;
    return result(cudaSuccess);
  }
  /// Takes memory of the caller for page-locked, for good.
  cudaError_t lock(void* memory, std::size_t bytes) {
    if (of_kernel != cudaSuccess) return result(of_kernel);
    const std::lock_guard<std::mutex> lock(mutex_);
    blocks_[memory] = {bytes, cudaMemoryTypeHost};
    return result(cudaSuccess);
  }
  cudaError_t free(void* memory, cudaMemoryType type) {
    if (memory == nullptr) return result(cudaSuccess);
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = blocks_.find(memory);
    if (found == blocks_.end() || found->second.type != type) return result(cudaErrorInvalidValue);
    if (type == cudaMemoryTypeDevice) used_ -= found->second.bytes;
    blocks_.erase(found);
    std::free(memory);
    return result(cudaSuccess);
  }
  cudaMemoryType type(const void* at) {
    const std::lock_guard<std::mutex> lock(mutex_);
    auto next = blocks_.upper_bound(const_cast<void*>(at));
    if (next == blocks_.begin()) return cudaMemoryTypeUnregistered;
    const auto& [first, block] = *--next;
    const auto offset = static_cast<const char*>(at) - static_cast<const char*>(first);
    return static_cast<std::size_t>(offset) < block.bytes ? block.type : cudaMemoryTypeUnregistered;
  }
  std::size_t left() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return kMemory - used_;
  }

 private:
  struct Block {
    std::size_t bytes;
    cudaMemoryType type;
  };
  std::mutex mutex_;
  std::map<void*, Block> blocks_;
  std::size_t used_ = 0;
};

Memory& memory() {
  static auto* const all = new Memory;  // buffers may be freed after everything else
  return *all;
}

/// Returns the stream that captures what is enqueued in a stream: itself, or one that it joins.
cudaStream_t capturing(cudaStream_t stream) {
  return stream && stream->joins && stream->joins->captures ? stream->joins : stream;
}

/// Does it, or keeps it for the graph that a stream captures. An error of it is for the next call,
/// as on a GPU, which has not done it yet.
cudaError_t enqueue(cudaStream_t stream, std::function<void()> work) {
  static Fault lost("lost");
  if (lost.is_due()) of_kernel = cudaErrorLaunchFailure;
  if (of_kernel != cudaSuccess) return result(of_kernel);
  stream = capturing(stream);
  if (stream != nullptr && stream->captures) {
    stream->captured.push_back(std::move(work));
  } else {
    work();
  }
  return cudaSuccess;
}

}  // namespace

namespace cuda_on_cpu {

int blocks_per_multiprocessor(int threads, std::size_t shared_bytes) {
  return threads <= kMostThreadsOfBlock && shared_bytes <= kSharedBytes ? 1 : 0;
}

cudaError_t launch(const cudaLaunchConfig_t& config, std::function<void()> thread) {
  const dim3 grid = config.gridDim, block = config.blockDim;
  const unsigned threads = block.x * block.y * block.z, blocks = grid.x * grid.y * grid.z;
  if (threads == 0 || blocks == 0 || threads > kMostThreadsOfBlock ||
      config.dynamicSmemBytes > kSharedBytes) {
    return result(cudaErrorInvalidValue);
  }
  bool at_once = false;
  for (unsigned i = 0; i < config.numAttrs; ++i) {
    at_once |= config.attrs[i].id == cudaLaunchAttributeCooperative;
  }
  if (at_once && blocks > static_cast<unsigned>(multiprocessors())) {
    return result(cudaErrorCooperativeLaunchTooLarge);
  }
  return enqueue(config.stream, [grid, block, at_once, thread = std::move(thread)] {
    if (of_kernel != cudaSuccess) return;
    try {
      run_blocks(grid, block, at_once, thread);
    } catch (const KernelError& error) {
      std::fprintf(stderr, "CUDA on the CPU: a kernel failed: %s\n", error.what());
      of_kernel = cudaErrorLaunchFailure;
    }
  });
}

}  // namespace cuda_on_cpu

const char* cudaGetErrorName(cudaError_t error) { return description(error).name; }
const char* cudaGetErrorString(cudaError_t error) { return description(error).text; }
cudaError_t cudaGetLastError() {
  if (of_kernel != cudaSuccess) return of_kernel;
  return std::exchange(last, cudaSuccess);
}
cudaError_t cudaDriverGetVersion(int* version) {
  *version = CUDART_VERSION;
  return result(cudaSuccess);
}

cudaError_t cudaGetDeviceCount(int* count) {
  *count = 1;
  return result(cudaSuccess);
}
cudaError_t cudaGetDevice(int* device) {
  *device = 0;
  return result(cudaSuccess);
}
cudaError_t cudaSetDevice(int device) {
  return result(device == 0 ? cudaSuccess : cudaErrorInvalidDevice);
}
cudaError_t cudaGetDeviceProperties(cudaDeviceProp* properties, int device) {
  if (device != 0) return result(cudaErrorInvalidDevice);
  *properties = {"CPU",
                 7,
                 5,
                 cuda_on_cpu::multiprocessors(),
                 cuda_on_cpu::kSharedBytes,
                 cuda_on_cpu::kSharedBytes + 1024};
  return result(cudaSuccess);
}
cudaError_t cudaDeviceGetAttribute(int* value, cudaDeviceAttr attribute, int device) {
  if (device != 0) return result(cudaErrorInvalidDevice);
  switch (attribute) {
    case cudaDevAttrMultiProcessorCount:
      *value = cuda_on_cpu::multiprocessors();
      break;
    case cudaDevAttrCooperativeLaunch:
      *value = 1;
      break;
    case cudaDevAttrComputeCapabilityMajor:
      *value = 7;
      break;
  }
  return result(cudaSuccess);
}
cudaError_t cudaDeviceGetPCIBusId(char*, int, int) { return cudaErrorNotSupported; }
cudaError_t cudaDeviceSynchronize() { return result(cudaSuccess); }

cudaError_t cudaMalloc(void** to, std::size_t bytes) {
  return memory().reserve(to, bytes, cudaMemoryTypeDevice);
}
cudaError_t cudaFree(void* at) { return memory().free(at, cudaMemoryTypeDevice); }
cudaError_t cudaHostAlloc(void** to, std::size_t bytes, unsigned) {
  return memory().reserve(to, bytes, cudaMemoryTypeHost);
}
cudaError_t cudaHostRegister(void* at, std::size_t bytes, unsigned) {
  return memory().lock(at, bytes);
}
cudaError_t cudaFreeHost(void* at) { return memory().free(at, cudaMemoryTypeHost); }
cudaError_t cudaMemGetInfo(std::size_t* free, std::size_t* total) {
  *free = memory().left();
  *total = kMemory;
  return result(cudaSuccess);
}
cudaError_t cudaPointerGetAttributes(cudaPointerAttributes* attributes, const void* at) {
  attributes->type = memory().type(at);
  return result(cudaSuccess);
}
cudaError_t cudaMemcpy(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind) {
  return cudaMemcpyAsync(to, from, bytes, kind, nullptr);
}
cudaError_t cudaMemcpyAsync(void* to, const void* from, std::size_t bytes, cudaMemcpyKind,
                            cudaStream_t stream) {
  return enqueue(stream, [=] { std::memcpy(to, from, bytes); });
}
cudaError_t cudaMemcpy2DAsync(void* to, std::size_t to_pitch, const void* from,
                              std::size_t from_pitch, std::size_t width, std::size_t height,
                              cudaMemcpyKind, cudaStream_t stream) {
  return enqueue(stream, [=] {
    for (std::size_t row = 0; row < height; ++row) {
      std::memcpy(static_cast<char*>(to) + row * to_pitch,
                  static_cast<const char*>(from) + row * from_pitch, width);
    }
  });
}
cudaError_t cudaMemset(void* at, int value, std::size_t bytes) {
  return cudaMemsetAsync(at, value, bytes, nullptr);
}
cudaError_t cudaMemsetAsync(void* at, int value, std::size_t bytes, cudaStream_t stream) {
  return enqueue(stream, [=] { std::memset(at, value, bytes); });
}

cudaError_t cudaStreamCreateWithFlags(cudaStream_t* stream, unsigned) {
  *stream = new CUstream_st;
  return result(cudaSuccess);
}
cudaError_t cudaStreamDestroy(cudaStream_t stream) {
  delete stream;
  return result(cudaSuccess);
}
cudaError_t cudaStreamSynchronize(cudaStream_t stream) {
  const bool captures = stream != nullptr && stream->captures;
  return result(captures ? cudaErrorStreamCaptureUnsupported : cudaSuccess);
}
// Work is done when it is enqueued, so events have nothing to wait for: they only carry captures
// from stream to stream.
cudaError_t cudaEventCreateWithFlags(cudaEvent_t* event, unsigned) {
  *event = new CUevent_st;
  return result(cudaSuccess);
}
cudaError_t cudaEventDestroy(cudaEvent_t event) {
  delete event;
  return result(cudaSuccess);
}
cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t stream) {
  event->recorded_in = capturing(stream);
  return result(cudaSuccess);
}
cudaError_t cudaEventSynchronize(cudaEvent_t) { return result(cudaSuccess); }
cudaError_t cudaStreamWaitEvent(cudaStream_t stream, cudaEvent_t event) {
  if (cudaStream_t from = event->recorded_in; from && from != stream && from->captures)
    stream->joins = from;
  return result(cudaSuccess);
}

cudaError_t cudaLaunchHostFunc(cudaStream_t stream, cudaHostFn_t function, void* data) {
  return enqueue(stream, [=] { function(data); });
}

cudaError_t cudaThreadExchangeStreamCaptureMode(cudaStreamCaptureMode*) {
  return result(cudaSuccess);
}
cudaError_t cudaStreamBeginCapture(cudaStream_t stream, cudaStreamCaptureMode) {
  stream->captures = true;
  return result(cudaSuccess);
}
cudaError_t cudaStreamEndCapture(cudaStream_t stream, cudaGraph_t* graph) {
  *graph = new CUgraph_st{std::move(stream->captured)};
  *stream = {};
  return result(cudaSuccess);
}
cudaError_t cudaGraphInstantiate(cudaGraphExec_t* executable, cudaGraph_t graph,
                                 unsigned long long) {
  *executable = new CUgraphExec_st{graph->work};
  return result(cudaSuccess);
}
cudaError_t cudaGraphLaunch(cudaGraphExec_t executable, cudaStream_t stream) {
  return enqueue(stream, [work = executable->work] {
    for (const auto& step : work) {
      if (of_kernel == cudaSuccess) step();
    }
  });
}
cudaError_t cudaGraphDestroy(cudaGraph_t graph) {
  delete graph;
  return result(cudaSuccess);
}
cudaError_t cudaGraphExecDestroy(cudaGraphExec_t executable) {
  delete executable;
  return result(cudaSuccess);
}
