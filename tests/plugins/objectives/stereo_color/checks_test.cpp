#include <gtest/gtest.h>

#include <string>

#include "hypotrack/api/error.hpp"
#include "hypotrack/gpu/device_objective.hpp"
#include "random_pair.hpp"
#include "settings.hpp"

namespace hypotrack::stereo_color {
namespace {

template <class Frame>
std::string message_of(const Frame& frame) {
  try {
    check(frame);
  } catch (const DataError& e) {
    return e.what();
  }
  return "no DataError";
}

// The same frame as it is described when its images are on a device.
std::string message_on_device(const Observation& observation) {
  Observation header = observation;
  cuda::DeviceObservation device;
  device.header = &header;
  for (std::size_t i = 0; i < header.views.size(); ++i) {
    device.tiles[i].has_color = !header.views[i].color.empty();
    header.views[i].color.release();
    header.views[i].valid.release();
  }
  return message_of(device);
}

TEST(Checks, OfADeviceFrameAreThoseOfTheSameFrame) {
  RandomPair good({.size = 32}), colourless({.size = 32}), single({.size = 32}), thin({.size = 32});
  colourless.observation.views[1].color.release();
  single.observation.views.pop_back();
  thin.observation.views[1].camera.width = 1;
  EXPECT_EQ(message_on_device(good.observation), "no DataError");
  for (const RandomPair* pair : {&colourless, &single, &thin}) {
    EXPECT_NE(message_of(pair->observation), "no DataError");
    EXPECT_EQ(message_on_device(pair->observation), message_of(pair->observation));
  }
}

}  // namespace
}  // namespace hypotrack::stereo_color
