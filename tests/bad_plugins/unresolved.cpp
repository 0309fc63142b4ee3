// Needs a function that no library has.
extern "C" int function_that_nobody_has();

extern "C" __attribute__((visibility("default"))) const void* hypotrack_plugin() {
  return function_that_nobody_has() ? nullptr : "";
}
