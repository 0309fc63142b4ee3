#include "base/profile.hpp"

#include <algorithm>
#include <exception>
#include <utility>

namespace hypotrack::internal {
namespace {

thread_local Profile* current = nullptr;

double seconds_between(std::chrono::steady_clock::time_point begin,
                       std::chrono::steady_clock::time_point end) {
  return std::chrono::duration<double>(end - begin).count();
}

}  // namespace

Profile::Profile(std::function<void()> wait) : wait_(std::move(wait)), parts_(1) {}

ProfileScope::ProfileScope(Profile& profile) : before_(std::exchange(current, &profile)) {}

ProfileScope::~ProfileScope() { current = before_; }

ProfiledPart::ProfiledPart(std::string_view name) : profile_(current) {
  if (!profile_) return;
  std::vector<Profile::Part>& parts = profile_->parts_;
  outer_ = profile_->current_;
  const auto is_it = [&](const Profile::Part& part) {
    return part.parent == outer_ && part.name == name;
  };
  const auto known = std::find_if(parts.begin() + 1, parts.end(), is_it);
  profile_->current_ = static_cast<std::size_t>(known - parts.begin());
  if (known == parts.end()) parts.push_back({.name = std::string(name), .parent = outer_});
  begin_ = std::chrono::steady_clock::now();
}

void ProfiledPart::add_beside(double seconds) {
  if (profile_) profile_->parts_[profile_->current_].beside_seconds += seconds;
}

ProfiledPart::~ProfiledPart() {
  if (!profile_) return;
  Profile::Part& part = profile_->parts_[profile_->current_];
  const auto worked = std::chrono::steady_clock::now();
  auto end = worked;
  if (profile_->wait_) {
    try {
      profile_->wait_();
    } catch (const std::exception&) {  // the thread's next use of the GPU reports it
    }
    end = std::chrono::steady_clock::now();
  }
  ++part.calls;
  part.seconds += seconds_between(begin_, end);
  part.waited_seconds += seconds_between(worked, end);
  profile_->current_ = outer_;
}

}  // namespace hypotrack::internal
