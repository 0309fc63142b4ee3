#pragma once

/// Marks what libhypotrack.so offers to plugins and programs; everything else stays hidden.
#define HYPOTRACK_API __attribute__((visibility("default")))
