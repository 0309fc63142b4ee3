#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Times the parts of a thread's work, nested as their scopes are. See ProfiledPart.
class Profile {
 public:
  /// A part of the work within another one.
  struct Part {
    std::string name;
    std::size_t parent = 0;  ///< its index in parts()
    long calls = 0;
    double seconds = 0;         ///< of its scopes, its inner parts included
    double waited_seconds = 0;  ///< of them, waiting for a GPU at the ends of scopes
    double beside_seconds = 0;  ///< work of other threads that its scopes began or waited for
  };

  /// Waits at the end of every scope by `wait`, which finishes a GPU's work; it may be empty.
  explicit Profile(std::function<void()> wait = {});

  /// Returns all parts in the order of their first scopes: inner parts come after their outer one.
  /// The first is the whole and has no name.
  const std::vector<Part>& parts() const { return parts_; }
  /// Forgets all parts. Precondition: none is running.
  void clear() { parts_.resize(1); }

 private:
  friend class ProfiledPart;
  friend class ProfileScope;

  std::function<void()> wait_;
  std::vector<Part> parts_;
  std::size_t current_ = 0;
};

/// Makes a profile that of the current thread, while it lives.
class ProfileScope {
 public:
  explicit ProfileScope(Profile& profile);
  ~ProfileScope();
  ProfileScope(const ProfileScope&) = delete;
  ProfileScope& operator=(const ProfileScope&) = delete;

 private:
  Profile* before_;
};

/// Counts the time of a scope as a part of the thread's profile, if it has one.
class ProfiledPart {
 public:
  explicit ProfiledPart(std::string_view name);
  ~ProfiledPart();
  /// Counts work that another thread did for this part.
  void add_beside(double seconds);
  ProfiledPart(const ProfiledPart&) = delete;
  ProfiledPart& operator=(const ProfiledPart&) = delete;

 private:
  Profile* profile_;
  std::size_t outer_ = 0;
  std::chrono::steady_clock::time_point begin_;
};

}  // namespace internal
}  // namespace hypotrack
