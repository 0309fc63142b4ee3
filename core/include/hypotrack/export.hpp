#pragma once

/// Marks a public name: visible outside its library, also where code is compiled with hidden
/// visibility.
#define HYPOTRACK_API __attribute__((visibility("default")))
