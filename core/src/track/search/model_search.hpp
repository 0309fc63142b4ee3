#pragma once

#include <cstdint>
#include <vector>

#include "base/exported.hpp"
#include "track/search/candidate_finder.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Collects candidates for one model of a frame that is lost or in a doubtful pose: around guesses,
/// and where starters see the model.
class CandidateFinder::ModelSearch {
 public:
  /// `held` flags models that move with the sought one. Writes evaluations and in_view to `best`.
  /// All arguments must outlive the object.
  ModelSearch(CandidateFinder& finder, const Frame& frame, const RecoveryRequest& request,
              const Candidate& base, Candidate& best, std::size_t model, const ModelFlags& held,
              std::uint64_t seed);

  void run();

  const std::vector<Candidate>& found() const { return found_; }
  /// Returns the seconds since a detector last saw the model near its pose in `state`; infinity if
  /// never.
  double unseen(const Eigen::VectorXd& state) const;
  /// Returns the models that the candidates show, and those of them that were searched.
  const ModelFlags& shown() const { return shown_; }
  const ModelFlags& moving() const { return moving_; }

 private:
  LastKnown last_known() const;
  Eigen::VectorXd with_own_part(Eigen::VectorXd to, const Eigen::VectorXd& from) const;
  bool enough() const;
  /// Searches from a state of the scene and adds what was found.
  void add(const Eigen::VectorXd& state);
  /// Searches again from where limbs lie elsewhere, if the pictures support that better.
  void improve_limbs(Candidate& one);
  /// Searches again with what the model holds put back to where it was held. Keeps the better pose.
  void put_back(Candidate& one);
  /// Searches the first places of the guesses. Calls `take` with states of the scene.
  template <class Take>
  void search_places(const GlobalSearchSettings& effort, std::size_t most, const Take& take);
  /// States of the scene that a starter proposes.
  struct Proposals {
    std::vector<Eigen::VectorXd> taken;
    std::vector<Eigen::VectorXd> known;  ///< where a tracked model already is
  };
  /// Asks one starter. `denied`: another one does not see the model, though it would. `may_search`:
  /// it may search the whole pictures.
  Proposals ask(Starter& starter, bool denied, bool may_search);
  void ask_starters();
  /// Lets the global search look at the first of these places only.
  void search_only_near(const std::vector<Eigen::VectorXd>& states);
  /// Returns how far apart two states have the model: metres, mean over its landmarks.
  double distance(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const;
  /// Returns whether a state that a starter proposes is that of the candidate which is followed.
  bool is_known(const Eigen::VectorXd& state) const;

  CandidateFinder& finder_;
  const Frame& frame_;
  const RecoveryRequest& request_;
  const Candidate& base_;
  Candidate& best_;
  const Scene::Item& item_;
  std::size_t model_;
  bool has_held_;
  std::uint64_t seed_;
  std::uint32_t part_ = 0;  ///< counts the seeds of parts
  ModelFlags shown_, moving_;
  Recovery::Task task_;
  std::vector<Candidate> found_;
  std::vector<Eigen::VectorXd> detected_;  ///< states proposed by starters that detect it
  bool is_followed_ = false;               ///< the frame's candidate shows the model
  bool sure_ = false;
};

}  // namespace internal
}  // namespace hypotrack
