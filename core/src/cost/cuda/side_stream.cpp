#include "cost/cuda/side_stream.hpp"

namespace hypotrack::cuda::internal {

SideStream::SideStream() {
  check(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "creating a stream");
  for (cudaEvent_t* event : {&forked_, &joined_}) {
    check(cudaEventCreateWithFlags(event, cudaEventDisableTiming), "creating an event");
  }
}

SideStream::~SideStream() {
  cudaEventDestroy(joined_);
  cudaEventDestroy(forked_);
  cudaStreamDestroy(stream_);
}

void SideStream::fork(Stream main) {
  check(cudaEventRecord(forked_, native(main)), "recording an event");
  check(cudaStreamWaitEvent(stream_, forked_), "waiting for an event");
}

void SideStream::join(Stream main) {
  check(cudaEventRecord(joined_, stream_), "recording an event");
  check(cudaStreamWaitEvent(native(main), joined_), "waiting for an event");
}

void SideStream::end() const {
  (void)cudaStreamSynchronize(stream_);
  (void)cudaGetLastError();  // its error was thrown already
}

}  // namespace hypotrack::cuda::internal
