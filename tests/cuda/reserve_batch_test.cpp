#include "cost/cuda/reserve_batch.hpp"

#include <gmock/gmock.h>

#include <vector>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::cuda {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::StartsWith;

/// Memory that holds `room` hypotheses.
struct Memory {
  std::int64_t room;
  std::vector<std::int64_t> asked = {};

  void operator()(std::int64_t count) {
    asked.push_back(count);
    if (count > room) throw DeviceError("CUDA: reserving memory failed");
  }
};

TEST(ReserveBatch, WhatFitsIsReservedOnce) {
  Memory memory{1000};
  reserve_batch(1000, std::ref(memory));
  EXPECT_THAT(memory.asked, ElementsAre(1000));
}

TEST(ReserveBatch, OfTooManyItSaysHowManyFit) {
  Memory memory{300};
  const std::string message =
      test::message_of<DeviceError>([&] { reserve_batch(1000, std::ref(memory)); });
  EXPECT_THAT(message, StartsWith("CUDA: reserving memory failed"));
  EXPECT_THAT(message, EndsWith("there is room for 250 hypotheses at a time, 1000 were asked for"));
  EXPECT_THAT(memory.asked, ElementsAre(1000, 500, 250));
}

TEST(ReserveBatch, WhereNothingFitsTheReasonStandsAlone) {
  Memory memory{0};
  EXPECT_EQ(test::message_of<DeviceError>([&] { reserve_batch(8, std::ref(memory)); }),
            "CUDA: reserving memory failed");
  EXPECT_THAT(memory.asked, ElementsAre(8, 4, 2, 1));
}

}  // namespace
}  // namespace hypotrack::cuda
