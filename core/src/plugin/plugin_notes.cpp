#include "plugin/plugin_notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "hypotrack/plugin/plugin_object.hpp"
#include "plugin/running_plugin.hpp"

namespace hypotrack {
namespace {

constexpr std::size_t kLongest = 500;  // bytes of a text
constexpr const char* kFurther = "has told 20 different things; further ones are only counted";

/// Returns a text of one line and limited length.
std::string one_line(std::string_view text) {
  std::string out(text.substr(0, kLongest));
  std::ranges::replace_if(
      out, [](unsigned char c) { return c < 32 || c == 127; }, ' ');
  return text.size() > kLongest ? out + "..." : out;
}

std::string line_of(const PluginNote& note) {
  return fmt::format("{}: {}{}: {}", note.warning ? "warning" : "note", note.who,
                     note.frame ? fmt::format(", frame {}", *note.frame) : "", note.text);
}

}  // namespace

PluginLog::PluginLog(std::shared_ptr<PluginNotes> notes, std::string who)
    : notes_(std::move(notes)), who_(std::move(who)) {}

void PluginLog::note(std::string_view text) const {
  if (notes_) notes_->add(who_, false, text);
}

void PluginLog::warning(std::string_view text) const {
  if (notes_) notes_->add(who_, true, text);
}

}  // namespace hypotrack

namespace hypotrack::internal {

void PluginNotes::add(const std::string& who, bool warning, std::string_view text) {
  const std::lock_guard lock(mutex_);
  auto& of_plugin = indices_[who];
  auto known = of_plugin.find(text);
  if (known == of_plugin.end() && of_plugin.size() >= kMostTexts) {
    text = kFurther;
    known = of_plugin.find(text);
  }
  if (known == of_plugin.end()) {
    known = of_plugin.emplace(text, notes_.size()).first;
    notes_.push_back({warning, who, detail::running_frame(), one_line(text)});
  }
  ++notes_[known->second].count;
}

std::vector<std::string> PluginNotes::take_lines() {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> lines;
  for (; told_ < notes_.size(); ++told_) lines.push_back(line_of(notes_[told_]));
  return lines;
}

std::vector<std::string> PluginNotes::repeated_lines() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> lines;
  for (const PluginNote& note : notes_)
    if (note.count > 1) lines.push_back(fmt::format("{} ({} times)", line_of(note), note.count));
  return lines;
}

std::vector<PluginNote> PluginNotes::all() const {
  const std::lock_guard lock(mutex_);
  return notes_;
}

}  // namespace hypotrack::internal
