#include "base/subprocess.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>
#include <thread>

#include "test_paths.hpp"

namespace hypotrack {
namespace {

using ::testing::StartsWith;
using ::testing::ThrowsMessage;
using Clock = std::chrono::steady_clock;

Subprocess::Command shell(const std::string& script) { return {"/bin/sh", {"-c", script}}; }

/// Waits for a file with a whole line, and returns it.
std::string first_line(const std::filesystem::path& file) {
  for (int i = 0; i < 2000; ++i) {
    std::ifstream in(file);
    std::string line;
    if (std::getline(in, line) && !in.eof()) return line;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ADD_FAILURE() << file << " stays empty";
  return {};
}

/// Waits until a process has ended; a zombie has.
bool ends(pid_t pid) {
  for (int i = 0; i < 2000; ++i) {
    std::ifstream in("/proc/" + std::to_string(pid) + "/stat");
    const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    if (text.empty() || text.find(") Z ") != std::string::npos) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

TEST(Subprocess, TellsTheExitCode) {
  EXPECT_EQ(Subprocess(shell("exit 0")).wait().code, 0);
  const Subprocess::End end = Subprocess(shell("exit 7")).wait();
  EXPECT_EQ(end.code, 7);
  EXPECT_EQ(end.signal, 0);
}

TEST(Subprocess, TellsTheSignalThatEndedIt) {
  const Subprocess::End end = Subprocess(shell("kill -SEGV $$")).wait();
  EXPECT_EQ(end.signal, SIGSEGV);
  EXPECT_EQ(end.code, 128 + SIGSEGV);
  EXPECT_EQ(signal_name(end.signal), "SIGSEGV");
  EXPECT_EQ(signal_name(40), "signal 40");
}

TEST(Subprocess, GetsArgumentsAsTheyAre) {
  const Captured captured =
      capture_output({"/bin/echo", {"two words", "", "$HOME", "'"}}, {STDOUT_FILENO});
  EXPECT_EQ(captured.output, "two words  $HOME '\n");
}

TEST(Subprocess, OutputLargerThanAPipeComesBackWhole) {
  const Captured captured =
      capture_output(shell("head -c 1000000 /dev/zero; printf end"), {STDOUT_FILENO});
  EXPECT_EQ(captured.output.size(), 1000003U);
  EXPECT_TRUE(captured.output.ends_with("end"));
  EXPECT_FALSE(captured.timed_out || captured.too_large);
}

TEST(Subprocess, CollectsOnlyTheGivenDescriptors) {
  const std::string script = "echo out; echo err >&2; echo three >&3";
  EXPECT_EQ(capture_output(shell(script), {3}).output, "three\n");
  EXPECT_EQ(capture_output(shell("echo out; echo err >&2"), {STDERR_FILENO}).output, "err\n");
  EXPECT_EQ(capture_output(shell("echo out; echo err >&2"), {STDOUT_FILENO, STDERR_FILENO}).output,
            "out\nerr\n");
}

TEST(Subprocess, IsKilledAtTheTimeLimit) {
  const auto begin = Clock::now();
  const Captured captured = capture_output(shell("echo begun; while :; do :; done"),
                                           {STDOUT_FILENO}, {std::chrono::milliseconds(300)});
  EXPECT_TRUE(captured.timed_out);
  EXPECT_EQ(captured.end.signal, SIGKILL);
  EXPECT_EQ(captured.output, "begun\n");
  EXPECT_LT(Clock::now() - begin, std::chrono::seconds(30));
}

TEST(Subprocess, IsKilledAtTheTimeLimitThoughItClosedItsOutput) {
  const Captured captured = capture_output(shell("exec >&-; sleep 1000"), {STDOUT_FILENO},
                                           {std::chrono::milliseconds(300)});
  EXPECT_TRUE(captured.timed_out);
}

TEST(Subprocess, IsKilledWhenItWritesTooMuch) {
  const Captured captured = capture_output(shell("yes"), {STDOUT_FILENO}, {std::nullopt, 100'000});
  EXPECT_TRUE(captured.too_large);
  EXPECT_FALSE(captured.timed_out);
}

TEST(Subprocess, AMissingProgramIsAnErrorThatNamesIt) {
  EXPECT_THAT([] { Subprocess({"/nowhere/program"}); },
              ThrowsMessage<std::system_error>(
                  StartsWith("/nowhere/program: cannot be started: No such file")));
  EXPECT_THAT([] { Subprocess({"/dev/null"}); },
              ThrowsMessage<std::system_error>(
                  StartsWith("/dev/null: cannot be started: Permission denied")));
}

TEST(Subprocess, AMissingFolderIsAnErrorThatNamesIt) {
  Subprocess::Command command = shell("exit 0");
  command.directory = "/nowhere";
  EXPECT_THAT([&] { Subprocess{command}; },
              ThrowsMessage<std::system_error>(StartsWith("/nowhere: cannot be entered: No such")));
  command.directory.clear();
  command.output = "/nowhere/log";
  EXPECT_THAT(
      [&] { Subprocess{command}; },
      ThrowsMessage<std::system_error>(StartsWith("/nowhere/log: cannot be written: No such")));
}

TEST(Subprocess, WritesItsFilesInItsFolder) {
  const test::TemporaryDirectory folder;
  Subprocess::Command command = shell("pwd; echo $NAME >&2; echo $PATH > path");
  command.directory = folder.path();
  command.variables = {"NAME=value", "PATH=/bin"};
  command.output = command.errors = folder.path() / "log";
  EXPECT_EQ(Subprocess(command).wait().code, 0);
  std::ifstream in(folder.path() / "log");
  const std::string log((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  EXPECT_EQ(log, std::filesystem::canonical(folder.path()).string() + "\nvalue\n");
  EXPECT_EQ(first_line(folder.path() / "path"), "/bin");
}

TEST(Subprocess, KeepsALockThatItIsGiven) {
  const test::TemporaryDirectory folder;
  const std::string file = folder.path() / "lock";
  const int lock = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  ASSERT_EQ(flock(lock, LOCK_EX | LOCK_NB), 0);
  Subprocess::Command command{"/bin/sleep", {"1000"}};
  command.descriptors = {{lock, lock}};
  Subprocess process(command);
  close(lock);
  const int other = open(file.c_str(), O_RDWR | O_CLOEXEC);
  EXPECT_NE(flock(other, LOCK_EX | LOCK_NB), 0);
  process.kill();
  EXPECT_EQ(flock(other, LOCK_EX | LOCK_NB), 0);
  close(other);
}

TEST(Subprocess, GetsSignals) {
  const test::TemporaryDirectory folder;
  Subprocess::Command command =
      shell("trap 'exit 5' TERM; echo ready; while :; do sleep 0.01; done");
  command.output = folder.path() / "out";
  Subprocess process(command);
  EXPECT_EQ(first_line(command.output), "ready");
  EXPECT_TRUE(process.running());
  EXPECT_FALSE(process.wait_until(Clock::now()));
  process.signal(SIGTERM);
  EXPECT_EQ(process.wait().code, 5);
  EXPECT_FALSE(process.running());
}

TEST(Subprocess, DiesWithItsObjectAndTakesItsChildrenAlong) {
  const test::TemporaryDirectory folder;
  Subprocess::Command command = shell("sleep 1000 & echo $! $$; wait");
  command.output = folder.path() / "out";
  std::vector<pid_t> pids(2);
  {
    const Subprocess process(command);
    std::istringstream(first_line(command.output)) >> pids[0] >> pids[1];
  }
  for (const pid_t pid : pids) EXPECT_TRUE(ends(pid)) << pid;
}

TEST(Subprocess, DiesWhenItsParentIsKilled) {
  const test::TemporaryDirectory folder;
  const auto file = folder.path() / "out";
  const pid_t parent = fork();
  if (parent == 0) {
    Subprocess::Command command = shell("echo $$; exec sleep 1000");
    command.output = file;
    Subprocess(command).wait();
    _exit(0);
  }
  const pid_t child = std::stoi("0" + first_line(file));
  ASSERT_GT(child, 0);
  ::kill(parent, SIGKILL);
  waitpid(parent, nullptr, 0);
  EXPECT_TRUE(ends(child));
}

TEST(Subprocess, WhatItLeavesRunningIsKilledAtItsEnd) {
  const test::TemporaryDirectory folder;
  const auto file = folder.path() / "out";
  Subprocess::Command command = shell("sleep 1000 & echo $!; exit 3");
  command.output = file;
  EXPECT_EQ(Subprocess(command).wait().code, 3);
  EXPECT_TRUE(ends(std::stoi("0" + first_line(file))));
}

TEST(Subprocess, StartsWhileOtherThreadsAllocate) {
  std::atomic<bool> stop = false;
  std::thread busy([&] {
    while (!stop) delete[] new char[1000];
  });
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(capture_output(shell("echo " + std::to_string(i)), {STDOUT_FILENO}).output,
              std::to_string(i) + "\n");
  stop = true;
  busy.join();
}

}  // namespace
}  // namespace hypotrack
