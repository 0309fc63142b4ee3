#include "lab/live/http_server.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

#include "lab/live/connection.hpp"
#include "lab/live/request_queue.hpp"
#include "plugin/running_plugin.hpp"

namespace hypotrack::internal {
namespace {

/// Gives a request without a length the length 0, which it has by RFC 9112, section 6.3. httplib
/// would take all that comes until the client hangs up for its body.
void complete(httplib::Request& request) {
  if (!request.has_header("Content-Length") && !request.has_header("Transfer-Encoding"))
    request.set_header("Content-Length", "0");
}

}  // namespace

void HttpServer::serve(const std::function<bool()>& relisten) {
  constexpr std::chrono::milliseconds kPause{100};
  while (!ended_) {
    try {
      if (listen_after_bind() || ended_) return;
    } catch (const std::exception&) {  // memory, threads or descriptors are short
    }
    std::this_thread::sleep_for(kPause);
    if (!ended_ && !is_running()) relisten();
  }
}

template <class Connection>
bool HttpServer::answer(Connection& connection) {
  bool closed = false;
  if constexpr (requires { process_request(connection, true, closed, complete); }) {
    return process_request(connection, true, closed, complete);
  } else {  // newer versions
    std::string remote, local;
    int remote_port = 0, local_port = 0;
    connection.get_remote_ip_and_port(remote, remote_port);
    connection.get_local_ip_and_port(local, local_port);
    return process_request(connection, remote, remote_port, local, local_port, true, closed,
                           complete);
  }
}

bool HttpServer::process_and_close_socket(socket_t socket) {
  constexpr std::size_t kMost = 1 << 20, kFrames = 4 << 10;  // of a body in chunks
  const detail::RunningPlugin page("the live page (--web)");
  Connection connection(socket, ended_, std::min(payload_max_length_, kMost) + kFrames);
  try {
    if (RequestQueue::refuses()) {
      connection.refuse("503 Service Unavailable", "too many connections; close another page");
      return false;
    }
    return connection.read_head() && answer(connection);
  } catch (...) {  // memory is short, or httplib does not like the request
    connection.refuse("500 Internal Server Error", "this request cannot be answered");
    return false;
  }
}

}  // namespace hypotrack::internal
