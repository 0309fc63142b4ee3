#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace hypotrack::fuzz {

/// Damages valid inputs in the ways that typing, merging and malice do. Equal seeds give equal
/// damage on every machine.
class Damage {
 public:
  /// `tokens` are words of the inputs' language. Neither list may be empty.
  Damage(std::uint64_t seed, std::vector<std::string> inputs, std::vector<std::string> tokens)
      : random_(seed), inputs_(std::move(inputs)), tokens_(std::move(tokens)) {}

  std::string damaged() {
    std::string text = pick(inputs_);
    for (auto n = 1 + below(6); n > 0; --n) change(text);
    return text;
  }

  void change(std::string& text) {
    const std::size_t at = below(text.size() + 1);
    const std::size_t length = std::min(below(20), text.size() - at);
    switch (below(7)) {
      case 0:
        text.insert(at, pick(tokens_));
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(below(text.size() + 1), text.substr(at, length));
        break;
      case 3:
        if (at < text.size()) text[at] = static_cast<char>(below(256));
        break;
      case 4:
        text.replace(at, length, pick(tokens_));
        break;
      case 5: {  // another input's end
        const std::string& other = pick(inputs_);
        text = text.substr(0, at) + other.substr(below(other.size()));
        break;
      }
      default:  // a token many times
        for (auto n = below(100); n > 0; --n) text.insert(at, pick(tokens_));
    }
  }

  std::size_t below(std::size_t limit) { return limit ? random_() % limit : 0; }

  template <class T>
  const T& pick(const std::vector<T>& from) {
    return from[below(from.size())];
  }

 private:
  std::mt19937_64 random_;
  std::vector<std::string> inputs_, tokens_;
};

}  // namespace hypotrack::fuzz
