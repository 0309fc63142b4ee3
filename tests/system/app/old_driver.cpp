// Stands in for the library of an NVIDIA driver that is older than the toolkit: it supports 11.4.
extern "C" {
__attribute__((visibility("default"))) int cuDriverGetVersion(int* version) {
  *version = 11040;
  return 0;
}
__attribute__((visibility("default"))) int cuInit(unsigned) { return 0; }
}
