#pragma once

/// Exports a symbol from libhypotrack.so to plugins and programs; all others stay hidden.
#define HYPOTRACK_API __attribute__((visibility("default")))
