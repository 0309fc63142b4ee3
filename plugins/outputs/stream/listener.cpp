#include "listener.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <chrono>
#include <utility>

#include "hypotrack/api/error.hpp"

namespace hypotrack::stream {
namespace {

namespace asio = boost::asio;
using Endpoint = asio::generic::stream_protocol::endpoint;
using Error = boost::system::error_code;

/// Makes room for a socket file: removes one that a crashed program has left. Throws OutputError if
/// something else is there.
void make_room(asio::io_context& io, const Endpoint& endpoint, const Address& address) {
  const std::filesystem::path& file = address.socket;
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::symlink_status(file, ignored);
  if (!std::filesystem::exists(status)) return;
  if (status.type() != std::filesystem::file_type::socket)
    throw OutputError(
        fmt::format("{}: {} is there already and is no socket; expected a free name, or the "
                    "socket of an earlier run. Name another file, or remove this one",
                    address.where, file.string()));
  Socket probe(io, endpoint.protocol());
  probe.native_non_blocking(true);
  const int connected =
      ::connect(probe.native_handle(), endpoint.data(), static_cast<socklen_t>(endpoint.size()));
  if (connected == 0 || errno == EAGAIN)
    throw OutputError(fmt::format(
        "{}: another program, perhaps a run, listens at {}; end it, or name another file",
        address.where, file.string()));
  if (errno != ECONNREFUSED)
    throw OutputError(
        fmt::format("{}: {} is a socket that cannot be replaced: {}; name another file",
                    address.where, file.string(), std::generic_category().message(errno)));
  std::filesystem::remove(file, ignored);  // bind() says why, if it is still there
}

Endpoint resolved(asio::io_context& io, const Address& address) {
  asio::ip::tcp::resolver resolver(io);
  Error error;
  const auto found = resolver.resolve(
      address.host, std::to_string(address.port),
      asio::ip::resolver_base::passive | asio::ip::resolver_base::numeric_service, error);
  if (error || found.empty())
    throw OutputError(
        fmt::format("{}: the host {} is not known ({}); expected an address of this machine, "
                    "such as 127.0.0.1, or 0.0.0.0 for all of them",
                    address.where, address.host, error.message()));
  return found.begin()->endpoint();
}

/// Says what to do about an address at which a program cannot listen.
std::string advice(const Address& address, const Error& error) {
  if (!address.socket.empty()) return "expected a folder in which files can be made";
  if (error == asio::error::address_in_use)
    return "end the program that listens there, or give "
           "another port";
  if (error == asio::error::access_denied) return "ports below 1024 need root; give another port";
  return "expected an address of this machine, such as 127.0.0.1, or 0.0.0.0 for all of them";
}

}  // namespace

Listener::Listener(asio::io_context& io, const Address& address) : acceptor_(io), pause_(io) {
  const bool local = !address.socket.empty();
  const Endpoint endpoint =
      local ? Endpoint(asio::local::stream_protocol::endpoint(address.socket.string()))
            : resolved(io, address);
  if (local) make_room(io, endpoint, address);
  Error error;
  acceptor_.open(endpoint.protocol(), error);
  if (!error && !local) acceptor_.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor_.bind(endpoint, error);
  if (!error && local) note_file(address.socket);
  if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
  if (error)
    throw OutputError(fmt::format("{}: cannot listen at {}: {}; {}", address.where, address.text(),
                                  error.message(), advice(address, error)));
}

Listener::~Listener() { remove_file(); }

void Listener::note_file(const std::filesystem::path& file) {
  struct stat made {};
  if (::lstat(file.c_str(), &made) != 0) return;
  file_ = file;
  device_ = made.st_dev;
  inode_ = made.st_ino;
}

/// Must come before the acceptor closes: until then its inode is not used again, and other programs
/// do not take the file for one that a crash has left.
void Listener::remove_file() {
  struct stat there {};
  const bool own = !file_.empty() && ::lstat(file_.c_str(), &there) == 0 &&
                   there.st_dev == device_ && there.st_ino == inode_;
  if (own) ::unlink(file_.c_str());
  file_.clear();
}

void Listener::accept(std::function<void(Socket)> take) {
  take_ = std::move(take);
  accept_next();
}

void Listener::accept_next() {
  acceptor_.async_accept([this](const Error& error, Socket socket) {
    if (!acceptor_.is_open()) return;
    if (!error) {
      take_(std::move(socket));
      return accept_next();
    }
    constexpr std::chrono::milliseconds kPause{100};  // this process may have too many open files
    pause_.expires_after(kPause);
    pause_.async_wait([this](const Error& ended) {
      if (!ended && acceptor_.is_open()) accept_next();
    });
  });
}

void Listener::close() {
  remove_file();
  Error ignored;
  acceptor_.close(ignored);
  pause_.cancel();
}

}  // namespace hypotrack::stream
