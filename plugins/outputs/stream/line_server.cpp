#include "line_server.hpp"

#include <fmt/format.h>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <future>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include "listener.hpp"

namespace hypotrack::stream {

namespace asio = boost::asio;

struct LineServer::Impl {
  Impl(const Address& address, std::string first_line, const Patience& given)
      : greeting(std::make_shared<const std::string>(std::move(first_line) + "\n")),
        patience(given),
        listener(std::in_place, io, address) {}

  void take(Socket socket);
  void finish_all();
  void end();

  Line greeting;
  Patience patience;
  asio::io_context io{1};
  std::optional<asio::executor_work_guard<asio::io_context::executor_type>> work{
      asio::make_work_guard(io)};
  std::optional<Listener> listener;
  std::set<std::shared_ptr<Reader>> readers;  ///< of the thread
  std::promise<void> done;
  std::thread thread;
};

void LineServer::Impl::take(Socket socket) {
  constexpr std::size_t kMostReaders = 32;
  const bool full = readers.size() >= kMostReaders;
  const auto forget = [this](const std::shared_ptr<Reader>& closed) { readers.erase(closed); };
  const auto reader = std::make_shared<Reader>(std::move(socket), patience, forget);
  if (!full) {
    readers.insert(reader);
    return reader->start(greeting);
  }
  reader->start(std::make_shared<const std::string>(fmt::format(
      "{{\"error\":\"{} readers are connected, which is the limit\"}}\n", kMostReaders)));
  reader->finish();
}

void LineServer::Impl::finish_all() {
  listener->close();
  const auto all = readers;  // a reader that closes leaves the set
  for (const auto& reader : all) reader->finish();
}

void LineServer::Impl::end() {
  io.stop();
  if (thread.joinable()) thread.join();
  listener.reset();
}

LineServer::LineServer(const Address& address, std::string greeting, const Patience& patience)
    : impl_(std::make_unique<Impl>(address, std::move(greeting), patience)) {
  Impl& self = *impl_;
  self.listener->accept([&self](Socket socket) { self.take(std::move(socket)); });
  self.thread = std::thread([&self] {
    self.io.run();
    self.done.set_value();
  });
}

LineServer::~LineServer() { impl_->end(); }

void LineServer::send(std::string line) {
  asio::post(impl_->io, [self = impl_.get(),
                         text = std::make_shared<const std::string>(std::move(line) + "\n")] {
    const auto all = self->readers;
    for (const auto& reader : all) reader->add(text);
  });
}

void LineServer::finish(std::chrono::milliseconds most) {
  asio::post(impl_->io, [self = impl_.get()] { self->finish_all(); });
  impl_->work.reset();
  impl_->done.get_future().wait_for(most);
  impl_->end();
}

}  // namespace hypotrack::stream
