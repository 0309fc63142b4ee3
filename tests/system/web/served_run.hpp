#pragma once

#include <httplib.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app_test.hpp"

namespace hypotrack::test {

/// A run of a small scene without an end, with its live view.
class ServedRun : public AppTest {
 protected:
  void TearDown() override;

  /// Starts the run and waits for the first frame. `more`: further options; `environment`:
  /// `NAME=value`.
  void start(const std::vector<std::string>& more = {},
             const std::vector<std::string>& environment = {});

  /// Returns a client of the page that has the token.
  httplib::Client client() const;
  int port() const { return port_; }
  /// Returns the word in the address that the run printed.
  const std::string& token() const { return token_; }
  Program& program() { return *program_; }

  httplib::Result get(const std::string& address, const httplib::Headers& headers = {}) const;
  /// Presses a button. Returns the HTTP status.
  int post(const std::string& command, const httplib::Headers& headers = {}) const;
  nlohmann::json state() const;
  /// Waits for a state of which `holds` is true.
  template <class Holds>
  nlohmann::json wait_for(const Holds& holds) {
    while (program_->running()) {
      const nlohmann::json now = state();
      if (holds(now)) return now;
    }
    ADD_FAILURE() << "the run ended: " << read_text(path("err"));
    return {};
  }
  /// Pauses and returns the frame at which the run stands.
  int pause();

 private:
  std::optional<Program> program_;
  int port_ = 0;
  std::string token_;
};

}  // namespace hypotrack::test
