#include "base/machine.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <string>

namespace hypotrack::internal {
namespace {

/// Takes a name as another process would, by its own socket.
class Another {
 public:
  explicit Another(const std::string& name) : socket_(socket(AF_UNIX, SOCK_STREAM, 0)) {
    sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
    const std::string text = "hypotrack/" + name;
    std::memcpy(address.sun_path + 1, text.data(), text.size());
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + text.size());
    taken_ = bind(socket_, reinterpret_cast<const sockaddr*>(&address), size) == 0;
  }
  ~Another() { close(socket_); }
  bool taken() const { return taken_; }

 private:
  int socket_;
  bool taken_;
};

std::string name_of_this_test() { return "test/" + std::to_string(getpid()); }

TEST(Claim, WhatAnotherProcessHasIsFreeAtItsEnd) {
  const std::string name = name_of_this_test() + "/a";
  {
    const Another another(name);
    ASSERT_TRUE(another.taken());
    EXPECT_FALSE(claim(name));
  }
  EXPECT_TRUE(claim(name));
}

TEST(Claim, IsKeptByTheProcess) {
  const std::string name = name_of_this_test() + "/b";
  EXPECT_TRUE(claim(name));
  EXPECT_TRUE(claim(name));
  EXPECT_FALSE(Another(name).taken());
}

TEST(Machine, HasTheMemoryThatThisProcessUses) {
  EXPECT_GT(memory_size(), std::size_t{64} << 20);
  EXPECT_LE(memory_size(), static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) *
                               static_cast<std::size_t>(sysconf(_SC_PAGESIZE)));
}

}  // namespace
}  // namespace hypotrack::internal
