#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/exported.hpp"
#include "config/yaml.hpp"

// Keys that scenes of version 0.2 have in `tracker`, which names a file since 0.3, and keys that
// have another name since.

namespace hypotrack::detail {
inline namespace HYPOTRACK_EXPORTED internal {

inline constexpr std::string_view kTracker = "tracker", kFrom = "from", kJudge = "judge";
inline constexpr std::string_view kEvidence = "evidence", kNetwork = "network", kNone = "none";

struct FormerKey {
  std::string_view key;       ///< in `tracker`
  std::string_view place;     ///< the map that has it now; empty: the scene itself
  std::string_view now = {};  ///< its name there; empty: the same
};

/// Returns a former key of `tracker`, or null. `evidence`, which has become a judge, is none.
const FormerKey* former_key(std::string_view key);

/// Returns the path of a former key now: `status.patience`.
std::string path_now(const FormerKey& key);

/// Returns the name of today of an entry of a scene's map, if its key has another one since 0.2. A
/// word may have another one, too: `value` is then true.
struct NewName {
  std::string_view name;
  bool is_of_value = false;
};
std::optional<NewName> new_name(const YamlNode& map, const YamlNode::Entry& entry);

/// Moves the values of former keys of a scene or tracker file to where they belong now. Returns a
/// note for the user for each map that had some. Throws ConfigError on keys that have no meaning in
/// `tracker`, and on `evidence` beside `judge`.
std::vector<std::string> move_former_keys(YamlNode& document);

/// Returns a path of today for one that may begin with a former key: `tracker.recovery.run`.
std::string path_today(std::string_view path);

/// Returns an override with its paths of today, and prepares the document for it: thresholds of a
/// judge that is a word make that a map. Adds a note if the override had a former key. Returns
/// nothing if it says what is so anyway.
std::optional<std::string> override_today(YamlNode& document, const std::string& assignment,
                                          std::vector<std::string>& notes);

/// Rewrites the former keys in the text of a scene, tracker file or study; all else stays as it is,
/// comments included. Throws ConfigError if the text is no YAML, or only its author can move a key.
std::string migrate(const std::string& text, const std::string& name);

}  // namespace internal
}  // namespace hypotrack::detail
