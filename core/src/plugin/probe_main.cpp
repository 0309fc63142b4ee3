// hypotrack_plugin_probe FILE: opens one plugin library for `hypotrack plugins` in a separate
// process and writes its report to file descriptor 3.
#include "base/standard_streams.hpp"
#include "plugin/library.hpp"

int main(int argc, char** argv) {
  hypotrack::open_standard_streams();
  if (argc != 2) return 2;
  hypotrack::detail::run_probe(argv[1]);
}
