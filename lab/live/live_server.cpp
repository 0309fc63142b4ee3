#include "lab/live/live_server.hpp"

#include <fmt/format.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>

#include "base/system_problem.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/files.hpp"
#include "lab/live/http_server.hpp"
#include "lab/live/request_queue.hpp"

namespace hypotrack::internal {

struct PageFile {
  std::string type;  ///< MIME type
  std::string content;
};

namespace {

std::string content_of(const std::string& name) {
  const std::filesystem::path file = data_file(name);
  std::string text = read_whole(file).value_or("");
  if (text.empty())
    throw DataError(fmt::format("{}: cannot be read; install hypotrack again", file.string()));
  return text;
}

std::string type_of(const std::filesystem::path& file) {
  const std::string suffix = file.extension().string();
  if (suffix == ".js") return "text/javascript; charset=utf-8";
  if (suffix == ".css") return "text/css; charset=utf-8";
  return suffix == ".html" ? "text/html; charset=utf-8" : "text/plain; charset=utf-8";
}

/// Reads the page of the live view and all files that it names, by their address ("/live.js").
/// Throws DataError if one cannot be read.
std::map<std::string, PageFile> live_page_files() {
  std::map<std::string, PageFile> files;
  // The 3D view is the report's.
  for (const char* name : {"live/live.css", "live/live.js", "live/running_plot.js",
                           "report/decode.js", "report/elements.js", "report/licences.txt",
                           "report/orbit_controls.js", "report/replay.js", "report/three.js"}) {
    const std::filesystem::path file(name);
    files["/" + file.filename().string()] = {type_of(file), content_of(name)};
  }
  files["/"] = {type_of("live.html"), content_of("live/live.html")};
  return files;
}

using httplib::DataSink;
using httplib::Request;
using httplib::Response;

constexpr int kMostStreams = 16;  // that are open at once
constexpr std::size_t kThreads = kMostStreams + 8;
constexpr std::size_t kMostWaiting = 24;             // connections
constexpr std::chrono::milliseconds kPatience{250};  // of one wait
constexpr int kWaits = 16;                           // for a reader that takes nothing
constexpr int kSendBuffer = 1 << 17;
// The socket takes this at once when it is writable.
constexpr std::size_t kPiece = 1 << 14;

/// Counts something while it lives.
class Counted {
 public:
  explicit Counted(std::atomic<int>& count) : count_(count) { ++count_; }
  ~Counted() { --count_; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;

 private:
  std::atomic<int>& count_;
};

/// Sends to a reader until it hangs or the server ends. Returns false then.
bool send(DataSink& sink, std::string_view text, const HttpServer& server) {
  int waits = 0;
  while (!text.empty()) {
    if (server.ended() && waits > 0) return false;
    if (!sink.is_writable()) {
      if (++waits > kWaits) return false;
      continue;
    }
    const std::string_view piece = text.substr(0, kPiece);
    if (!sink.write(piece.data(), piece.size())) return false;
    text.remove_prefix(piece.size());
  }
  return true;
}

/// Sends every value that a reader has time for, as `part` writes it, until no more come.
template <class Part>
void send_values(const Latest<std::string>& values, DataSink& sink, const HttpServer& server,
                 const Part& part) {
  std::uint64_t seen = 0;
  while (true) {
    const bool last = values.closed();
    const auto entry = values.wait_after(seen, kPatience);
    if (entry.number > seen) {
      seen = entry.number;
      if (!send(sink, part(*entry.value), server)) return;
    } else if (last || server.ended() || !sink.is_writable()) {
      return;
    }
  }
}

std::string cookie_name(int port) { return fmt::format("hypotrack_{}", port); }

/// Returns the token that a request brings: in its address, a header or a cookie.
std::string token_of(const Request& request, int port) {
  constexpr std::string_view kBearer = "Bearer ";
  if (request.has_param("token")) return request.get_param_value("token");
  const std::string bearer = request.get_header_value("Authorization");
  if (bearer.starts_with(kBearer)) return bearer.substr(kBearer.size());
  const std::string cookies = "; " + request.get_header_value("Cookie") + ";";
  const std::string key = "; " + cookie_name(port) + "=";
  const std::size_t at = cookies.find(key);
  if (at == std::string::npos) return {};
  return cookies.substr(at + key.size(), cookies.find(';', at + 1) - at - key.size());
}

/// Returns the regular expression of exactly this address.
std::string pattern_of(const std::string& address) {
  std::string out;
  for (const char c : address) out += c == '.' ? std::string("\\.") : std::string(1, c);
  return out;
}

httplib::Headers safe_headers() {
  return {{"Cache-Control", "no-store"},
          {"Content-Security-Policy",
           "default-src 'self'; img-src 'self' data:; style-src 'self'; frame-ancestors 'none'"},
          {"Cross-Origin-Resource-Policy", "same-origin"},
          {"Referrer-Policy", "no-referrer"},
          {"X-Content-Type-Options", "nosniff"}};
}

}  // namespace

struct LiveServer::Impl {
  Impl(AccessRules access, Parts served) : rules(std::move(access)), parts(served) {}

  void listen(int wanted);
  void start_threads();
  void route();
  void route_streams();
  void route_commands();
  void stream(Response& response, const std::string& type, std::function<void(DataSink&)> send_all);
  bool refuse(const Request& request, Response& response) const;

  AccessRules rules;
  Parts parts;
  std::map<std::string, PageFile> files = live_page_files();
  int port = 0;
  std::atomic<int> streams = 0;
  HttpServer server;
  std::unique_ptr<RequestQueue> queue;  ///< the server's first
  std::thread thread;
};

void LiveServer::Impl::listen(int wanted) {
  server.set_default_headers(safe_headers());
  // A port has one server: no SO_REUSEPORT, which httplib sets otherwise.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    setsockopt(socket, SOL_SOCKET, SO_SNDBUF, &kSendBuffer, sizeof kSendBuffer);
  });
  server.set_tcp_nodelay(true);
  server.set_payload_max_length(4096);
  errno = 0;
  port = wanted == 0                               ? server.bind_to_any_port(rules.host)
         : server.bind_to_port(rules.host, wanted) ? wanted
                                                   : -1;
  if (port <= 0)
    throw ConfigError(fmt::format(
        "--web {}: cannot listen on {} port {}: {}; give another port, or 0 for any that is free",
        wanted, rules.host, wanted,
        errno == 0 ? "no such host" : std::generic_category().message(errno)));
}

void LiveServer::Impl::start_threads() {
  try {
    queue = std::make_unique<RequestQueue>(kThreads, kMostWaiting);
    server.new_task_queue = [this] {
      return queue ? queue.release() : new RequestQueue(kThreads, kMostWaiting);
    };
    thread = std::thread(
        [this] { server.serve([this] { return server.bind_to_port(rules.host, port); }); });
  } catch (const std::system_error& error) {
    throw ConfigError(fmt::format("--web: the page needs {} threads: {}; or run without --web",
                                  kThreads + 1, described(error)));
  }
}

bool LiveServer::Impl::refuse(const Request& request, Response& response) const {
  const std::string why =
      refusal(rules, {.host = request.get_header_value("Host"),
                      .origin = request.get_header_value("Origin"),
                      .fetch_site = request.get_header_value("Sec-Fetch-Site"),
                      .navigates = request.method == "GET" && request.path == "/" &&
                                   request.get_header_value("Sec-Fetch-Mode") == "navigate",
                      .token = token_of(request, port)});
  if (why.empty()) return false;
  response.status = 403;
  response.set_content("hypotrack: " + why + "\n", "text/plain; charset=utf-8");
  return true;
}

void LiveServer::Impl::stream(Response& response, const std::string& type,
                              std::function<void(DataSink&)> send_all) {
  if (streams >= kMostStreams) {
    response.status = 503;
    response.set_content("hypotrack: too many viewers; close another page\n",
                         "text/plain; charset=utf-8");
    return;
  }
  response.set_content_provider(
      type, [this, send_all = std::move(send_all)](std::size_t, DataSink& sink) {
        const Counted counted(streams);
        send_all(sink);
        sink.done();
        return false;
      });
}

void LiveServer::Impl::route() {
  server.set_pre_routing_handler([this](const Request& request, Response& response) {
    return refuse(request, response) ? httplib::Server::HandlerResponse::Handled
                                     : httplib::Server::HandlerResponse::Unhandled;
  });
  for (const auto& [address, file] : files)
    server.Get(pattern_of(address), [this, &file = file](const Request& request,
                                                         Response& response) {
      if (!rules.token.empty() && request.has_param("token"))
        response.set_header("Set-Cookie", fmt::format("{}={}; HttpOnly; SameSite=Strict; Path=/",
                                                      cookie_name(port), rules.token));
      response.set_content(file.content, file.type);
    });
  const auto json = [this](const char* address, std::function<std::string()> text) {
    server.Get(address, [text = std::move(text)](const Request&, Response& response) {
      response.set_content(text(), "application/json");
    });
  };
  json("/state", [this] { return *parts.state.states().get().value; });
  json("/scene", [this] { return parts.state.scene_json(); });
  json("/history", [this] { return parts.state.history_json(); });
}

void LiveServer::Impl::route_streams() {
  const auto events = [this](const char* address, const Latest<std::string>& values) {
    server.Get(address, [this, &values](const Request&, Response& response) {
      stream(response, "text/event-stream", [this, &values](DataSink& sink) {
        send_values(values, sink, server,
                    [](const std::string& value) { return "data: " + value + "\n\n"; });
      });
    });
  };
  events("/events", parts.state.states());
  events("/solutions", parts.state.solutions());
  for (const ViewLayout layout : {ViewLayout::row, ViewLayout::column}) {
    PictureChannel& channel = parts.pictures.channel(layout);
    const bool row = layout == ViewLayout::row;
    server.Get(row ? "/pictures/row" : "/pictures/column",
               [this, &channel](const Request&, Response& response) {
                 stream(response, "multipart/x-mixed-replace; boundary=picture",
                        [this, &channel](DataSink& sink) {
                          const Counted watched(channel.watchers);
                          // Browsers show a part when the next one begins.
                          if (!send(sink, "--picture\r\n", server)) return;
                          send_values(channel.pictures, sink, server, [](const std::string& jpeg) {
                            return fmt::format(
                                "Content-Type: image/jpeg\r\nContent-Length: {}\r\n\r\n{}\r\n"
                                "--picture\r\n",
                                jpeg.size(), jpeg);
                          });
                        });
               });
  }
}

void LiveServer::Impl::route_commands() {
  const auto command = [this](const char* address, std::function<void()> act) {
    server.Post(address, [act = std::move(act)](const Request&, Response& response) {
      act();
      response.status = 204;
    });
  };
  RunControls& controls = parts.controls;
  command("/pause", [&controls] { controls.pause(); });
  command("/resume", [&controls] { controls.resume(); });
  command("/step", [&controls] { controls.step(); });
  command("/restart", [&controls] { controls.ask_for_restart(); });
  command("/snapshot", [&controls] { controls.ask_for_snapshot(); });
}

LiveServer::LiveServer(const AccessRules& rules, int port, Parts parts)
    : impl_(std::make_unique<Impl>(rules, parts)) {
  impl_->route();
  impl_->route_streams();
  impl_->route_commands();
  impl_->listen(port);
  impl_->start_threads();
  while (!impl_->server.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

LiveServer::~LiveServer() {
  impl_->server.end();
  impl_->server.stop();
  impl_->thread.join();
}

int LiveServer::port() const { return impl_->port; }

}  // namespace hypotrack::internal
