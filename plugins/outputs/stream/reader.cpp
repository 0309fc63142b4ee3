#include "reader.hpp"

#include <fmt/format.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <utility>

namespace hypotrack::stream {
namespace {

namespace asio = boost::asio;
using Error = boost::system::error_code;
using Clock = std::chrono::steady_clock;

/// Adds a key to the JSON object of a line.
std::string with_dropped(std::string line, std::size_t dropped) {
  const std::size_t end = line.rfind('}');
  return line.replace(end, std::string::npos, fmt::format(",\"dropped\":{}}}\n", dropped));
}

}  // namespace

Reader::Reader(Socket socket, const Patience& patience, Closed closed)
    : socket_(std::move(socket)),
      patience_(patience),
      closed_(std::move(closed)),
      timer_(socket_.get_executor()) {
  // The kernel's own queue is to be short: what waits in it cannot be dropped.
  constexpr int kSendBuffer = 1 << 16;
  Error ignored;
  socket_.set_option(asio::socket_base::send_buffer_size(kSendBuffer), ignored);
  socket_.set_option(asio::ip::tcp::no_delay(true), ignored);  // fails on a socket file
}

void Reader::start(const Line& greeting) {
  receive();
  send(*greeting);
}

void Reader::add(const Line& line) {
  if (!socket_.is_open() || finishing_) return;
  if (waiting_.size() >= patience_.lines) {
    waiting_.pop_front();
    ++dropped_;
  }
  waiting_.push_back(line);
  if (unsent_.empty()) send_next();
}

void Reader::finish() {
  finishing_ = true;
  if (unsent_.empty()) send_next();
}

void Reader::send_next() {
  if (waiting_.empty()) {
    if (finishing_) close();
    return;
  }
  const Line line = std::move(waiting_.front());
  waiting_.pop_front();
  send(dropped_ == 0 ? *line : with_dropped(*line, dropped_));
  dropped_ = 0;
}

void Reader::send(std::string text) {
  unsent_ = std::move(text);
  send_rest();
}

void Reader::send_rest() {
  const auto self = shared_from_this();
  timer_.expires_after(patience_.hangs);
  timer_.async_wait([self](const Error& ended) {
    if (!ended && self->timer_.expiry() <= Clock::now()) self->close();
  });
  socket_.async_write_some(asio::buffer(unsent_), [self](const Error& error, std::size_t sent) {
    self->timer_.expires_at(Clock::time_point::max());
    self->unsent_.erase(0, sent);
    if (error) return self->close();
    if (self->unsent_.empty()) return self->send_next();
    self->send_rest();
  });
}

void Reader::receive() {
  // A reader that sends no more (`nc -N`) may read on.
  socket_.async_read_some(asio::buffer(received_),
                          [self = shared_from_this()](const Error& error, std::size_t) {
                            if (!error) return self->receive();
                            if (error != asio::error::eof) self->close();
                          });
}

void Reader::close() {
  if (!socket_.is_open()) return;
  Error ignored;
  socket_.shutdown(asio::socket_base::shutdown_send, ignored);
  socket_.close(ignored);
  timer_.cancel();
  waiting_.clear();
  closed_(shared_from_this());
}

}  // namespace hypotrack::stream
