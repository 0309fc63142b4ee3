#pragma once

#include <string>
#include <system_error>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns what to do about an error number of the system; empty: nothing is known.
std::string advice_on(int error);

/// Returns true if an error number says that the program or the computer has too little of
/// something, whatever the file is.
bool is_shortage(int error);

/// Returns a message of others, with advice_on() a shortage that it names and says nothing on.
std::string with_advice(std::string message);

/// Returns `the message of an error number; advice`.
std::string described(int error);

/// Returns where and what an operation of the system failed, why, and what to do.
std::string described(const std::system_error& error);

}  // namespace internal
}  // namespace hypotrack
