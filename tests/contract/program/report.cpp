#include "report.hpp"

#include <iostream>

namespace hypotrack::contract {
namespace {

/// Runs a check. Returns empty texts if it passed, otherwise the status and the reason.
std::pair<std::string, std::string> run(const Report::Check& check) {
  try {
    check();
    return {"ok", ""};
  } catch (const Skipped& skipped) {
    return {"skipped", skipped.what()};
  } catch (const Violation& violation) {
    return {"FAILED", violation.what()};
  } catch (const std::exception& error) {
    return {"FAILED", "did not expect an exception, but got: " + std::string(error.what())};
  } catch (...) {
    return {"FAILED", "did not expect an exception, but got one that is no std::exception"};
  }
}

}  // namespace

void Report::row(std::string_view name, const Check& check) {
  std::cout << name << ": " << std::flush;
  const auto [status, reason] = run(check);
  std::cout << status << (reason.empty() ? "" : "\n    " + reason) << std::endl;
  last_passed_ = status == "ok";
  ++(last_passed_ ? passed_ : status == "FAILED" ? failed_ : skipped_);
}

int Report::finish() const {
  std::cout << passed_ << " passed, " << failed_ << " failed, " << skipped_ << " skipped"
            << std::endl;
  return failed_ == 0 ? 0 : 1;
}

}  // namespace hypotrack::contract
