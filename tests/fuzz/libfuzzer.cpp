// libFuzzer's side of the targets. The program's name says which one it runs: fuzz_NAME.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "target.hpp"

namespace {

using hypotrack::fuzz::Target;

const Target* target = nullptr;

/// Returns the target of a program's name; ends the program if there is none.
const Target& named(const std::filesystem::path& program) {
  const std::vector<Target>& all = hypotrack::fuzz::targets();
  const std::string name = program.filename().string();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Target& one) {
    return name == "fuzz_" + std::string(one.name);
  });
  if (found != all.end()) return *found;
  std::fprintf(stderr, "%s: is named after no target; expected fuzz_NAME\n", name.c_str());
  std::exit(2);
}

}  // namespace

/// Finds the target and adds its dictionary to the arguments.
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  target = &named((*argv)[0]);
  const auto file = hypotrack::fuzz::fuzz_folder() / "dictionaries" / target->dictionary;
  static std::string dictionary = "-dict=" + file.string() + ".dict";
  static std::vector<char*> arguments(*argv, *argv + *argc);
  arguments.insert(arguments.begin() + 1, dictionary.data());
  *argc = static_cast<int>(arguments.size());
  arguments.push_back(nullptr);
  *argv = arguments.data();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  hypotrack::fuzz::attempt([&] { target->read(bytes); });
  return 0;
}

// Undefined behaviour ends the program, as every other fault does.
extern "C" const char* __ubsan_default_options() { return "halt_on_error=1:print_stacktrace=1"; }
