// Loaded before a program (LD_PRELOAD), this stands in for an FFmpeg without encoders.

extern "C" __attribute__((visibility("default"))) const void* avcodec_find_encoder_by_name(
    const char* /*name*/) {
  return nullptr;
}
