#include "lab/judge/pose_recoveries.hpp"

namespace hypotrack::internal {

PoseRecoveries::PoseRecoveries(const std::filesystem::path& scene,
                               const std::vector<std::string>& overrides, PluginLoader& plugins)
    : session_(open_scene(scene, overrides, plugins)),
      scene_(*session_.scene),
      budget_(session_.parts.budget),
      limits_(session_.parts.status.motion),
      verifier_(scene_, session_.source->cameras(), session_.parts.judge),
      recovery_(scene_, session_.source->cameras(), session_.parts.status.recovery) {
  session_.parts.cameras = session_.source->cameras();
  search_.emplace(scene_, session_.parts);
  if (budget_.evaluations == 0) budget_.evaluations = search_->default_evaluations();
}

RecoveredStates PoseRecoveries::find(const Frame& frame, const Eigen::VectorXd& kept,
                                     double seconds, std::size_t model,
                                     const std::vector<bool>& shown, std::uint64_t seed) {
  RecoveredStates out;
  if (!verifier_.experienced(model)) return out;
  search_->show(shown);
  Recovery::Task task =
      recovery_.begin(*search_, frame, verifier_, {kept, seconds}, model, shown, {});
  recovery_.look(task, limits_);
  std::vector<bool> moving(shown.size(), false);
  moving[model] = true;
  for (const PoseGuess& guess : task.guesses) {
    const Candidates found = recovery_.find(task, guess, {}, limits_, seed++);
    search_->show(shown, moving);
    for (const Eigen::VectorXd& state : found.states) {
      if (search_->tiles().visible_share(state) == 0) continue;
      search_->look(frame, state, false);
      out.candidates.push_back(state);
      out.searched.push_back(search_->settled(state, budget_, seed).state);
    }
  }
  return out;
}

void PoseRecoveries::learn(const Frame& frame, const Eigen::VectorXd& state) {
  const std::vector<bool> all(scene_.items().size(), true);
  search_->show(all);
  if (first_) search_->from_guess(frame, state, budget_, 1);
  first_ = false;
  search_->look(frame, state, false);
  search_->learn(frame, state);
  verifier_.verify(frame, state, search_->second_view_colors(), all);
  verifier_.learn(all);
  recovery_.remember(state, all);
  recovery_.learn_backgrounds(frame, state);
}

}  // namespace hypotrack::internal
