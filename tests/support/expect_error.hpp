#pragma once

#include <gmock/gmock.h>

#include <string>

namespace hypotrack::test {

/// Returns the message of the E that `action` throws; fails the test if it throws none.
template <class E, class Action>
std::string message_of(Action action) {
  try {
    action();
  } catch (const E& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return "";
}

}  // namespace hypotrack::test
