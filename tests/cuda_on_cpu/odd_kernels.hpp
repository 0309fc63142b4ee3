#pragma once

#include <cuda_runtime.h>

#include <vector>

/// Kernels that show how the CPU stands in for a GPU, and what it says of broken ones.
namespace hypotrack::test {

enum class Barriers { all, one_is_missing };
/// 1 + 2 + ... + the number of threads, added up in shared memory by halves.
int sum_of_block(int threads, Barriers barriers = Barriers::all);

/// What the lanes of a warp get of one another: of lane 5, of their neighbour (lane ^ 1), of the
/// lane two below (or their own), and the bits of the lanes that are multiples of 3.
struct Exchanges {
  std::vector<int> of_five, of_neighbour, of_below;
  std::vector<unsigned> multiples;
};
Exchanges exchange_in_warp();

/// Block 0 waits for a number from each of the others, all of them at once on the device, and adds
/// them up.
double sum_over_blocks(unsigned blocks);

struct Roundings {
  float up, down;
};
Roundings round_sum(float a, float b);
unsigned permute_bytes(unsigned low, unsigned high, unsigned selector);

enum class Mistake { trap, lanes_do_different_things, wait_in_vain };
/// The error of a kernel that makes it.
cudaError_t run_broken_kernel(Mistake mistake);

}  // namespace hypotrack::test
