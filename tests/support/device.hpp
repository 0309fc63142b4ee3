#pragma once

#include <gtest/gtest.h>

#include "cost/cuda/device.hpp"

/// Skips a test where no GPU can be used, and says why.
#define SKIP_WITHOUT_DEVICE()                                                 \
  if (const std::string why = hypotrack::cuda::why_no_device(); !why.empty()) \
  GTEST_SKIP() << "needs a GPU: " << why
