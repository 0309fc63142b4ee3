#!/usr/bin/env bash
# A program that tracks two people on one GPU gives each tracker a thread and a stream, and captures graphs in a mode that,
# by its name, restricts only the capturing thread. A cudaDeviceSynchronize() of the other thread fails all the same, and
# it ends the capture, whose next call fails too. Both trackers then stop with errors about streams that neither of them
# shares, and only when a capture and a wait happen to meet.
set -euo pipefail

export PATH=$PATH:/usr/local/cuda/bin
nvcc=$(command -v nvcc) || { echo "missing: nvcc of CUDA 13.0"; exit 77; }
"$nvcc" --version | grep -o 'release 13\.[^,]*' || { echo "missing: nvcc of CUDA 13"; exit 77; }

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat >"$folder/main.cu" <<'CODE'
#include <cuda_runtime.h>

#include <cstdio>
#include <thread>

struct Seen {
  cudaError_t wait, capture;
};

/// Captures work in a stream while another thread waits, for its own stream or for the device.
Seen capture_beside(bool for_device, cudaStream_t mine, cudaStream_t others, void* memory) {
  Seen seen{};
  cudaStreamBeginCapture(mine, cudaStreamCaptureModeThreadLocal);
  cudaMemsetAsync(memory, 0, 16, mine);
  std::thread([&] {
    seen.wait = for_device ? cudaDeviceSynchronize() : cudaStreamSynchronize(others);
  }).join();
  cudaMemsetAsync(memory, 1, 16, mine);
  cudaGraph_t graph = nullptr;
  seen.capture = cudaStreamEndCapture(mine, &graph);
  if (graph) cudaGraphDestroy(graph);
  cudaGetLastError();
  return seen;
}

int main() {
  int devices = 0, driver = 0;
  if (cudaGetDeviceCount(&devices) != cudaSuccess || devices == 0) {
    std::puts("missing: an NVIDIA GPU");
    return 77;
  }
  cudaDriverGetVersion(&driver);
  std::printf("driver for CUDA %d.%d\n", driver / 1000, driver % 1000 / 10);
  cudaStream_t mine = nullptr, others = nullptr;
  void* memory = nullptr;
  cudaStreamCreateWithFlags(&mine, cudaStreamNonBlocking);
  cudaStreamCreateWithFlags(&others, cudaStreamNonBlocking);
  cudaMalloc(&memory, 16);
  const Seen stream = capture_beside(false, mine, others, memory);
  const Seen device = capture_beside(true, mine, others, memory);
  std::puts("expected: another thread may wait for its stream and for the device; the capture goes on");
  std::printf("seen:     wait for a stream: %s, capture: %s\n", cudaGetErrorName(stream.wait),
              cudaGetErrorName(stream.capture));
  std::printf("          wait for the device: %s, capture: %s\n", cudaGetErrorName(device.wait),
              cudaGetErrorName(device.capture));
  const bool stream_works = stream.wait == cudaSuccess && stream.capture == cudaSuccess;
  const bool device_fails = device.wait != cudaSuccess && device.capture != cudaSuccess;
  return stream_works && device_fails ? 0 : 1;
}
CODE
"$nvcc" -std=c++17 -o "$folder/main" "$folder/main.cu"
"$folder/main"
