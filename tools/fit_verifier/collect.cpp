// Writes evidence of right and wrong poses of a rendered scene, for fit.py: what the scene's
// tracker finds, the true pose, poses off by 1 to 200 mm, and what recoveries find that do not know
// where the models are. The verifier has learned from what the tracker found where that is right,
// else from the true pose: they differ where the rendered hand has another shape than the model.
//
//   collect_evidence SCENE.yaml OUT.csv FRAMES SEED [KEY=VALUE...]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "hypotrack/kinematics.hpp"
#include "hypotrack/plugin.hpp"
#include "hypotrack/search.hpp"
#include "session/opened_scene.hpp"
#include "track/color/photometric.hpp"
#include "track/displace.hpp"
#include "track/loop/scene_tracker.hpp"
#include "track/recover/recovery.hpp"
#include "track/verify/pose_verifier.hpp"

namespace hypotrack {
namespace {

/// Mean distance (mm) of a model's landmarks in two states.
double error_mm(const Scene::Item& item, const Eigen::VectorXd& a, const Eigen::Matrix3Xd& truth,
                Eigen::Index first) {
  const std::span<const double> own(a.data() + item.offset,
                                    static_cast<std::size_t>(item.model->dimension()));
  const Eigen::Matrix3Xd found = posed_landmarks(*item.model, own);
  double sum = 0;
  int count = 0;
  for (Eigen::Index i = 0; i < found.cols(); ++i) {
    const double d = (found.col(i) - truth.col(first + i)).norm();
    if (std::isfinite(d)) sum += d, ++count;
  }
  return count > 0 ? 1000 * sum / count : std::nan("");
}

/// Whether every model's landmarks are within 10 mm of the truth.
bool all_right(const Scene& scene, const Eigen::VectorXd& state, const Eigen::Matrix3Xd& truth) {
  Eigen::Index first = 0;
  for (const Scene::Item& item : scene.items()) {
    if (!(error_mm(item, state, truth, first) <= 10)) return false;
    first += static_cast<Eigen::Index>(item.model->data().landmarks.size());
  }
  return true;
}

class Collector {
 public:
  Collector(const Scene& scene, const std::vector<Camera>& cameras, std::FILE* out)
      : scene_(scene), out_(out) {
    for (std::size_t m = 0; m < scene.items().size(); ++m) {
      verifiers_.emplace_back(scene, m, cameras);
      fresh_.emplace_back(scene, m, cameras);
    }
    fmt::print(out_,
               "kind,frame,model,error,absent,covered,points,likeness,usual_likeness,"
               "known,experienced");
    for (const char* prefix : {"", "d_"})
      for (const auto name : evidence_names()) fmt::print(out_, ",{}{}", prefix, name);
    fmt::print(out_, "\n");
  }

  /// Adds a row per model of `shown`.
  void add(const char* kind, const Frame& frame, const Eigen::VectorXd& state,
           const Eigen::Matrix3Xd& truth, const std::vector<bool>& absent, const ColorMap& colors,
           const std::vector<bool>& shown) {
    Eigen::Index first = 0;
    for (std::size_t m = 0; m < verifiers_.size(); ++m) {
      const Scene::Item& item = scene_.items()[m];
      const double error = absent[m] ? 999 : error_mm(item, state, truth, first);
      first += static_cast<Eigen::Index>(item.model->data().landmarks.size());
      if (!shown[m]) continue;
      for (ModelVerifier* verifier : {&verifiers_[m], &fresh_[m]}) {
        const Evidence e = verifier->measure_evidence(frame, state, colors);
        fmt::print(out_, "{},{},{},{:.2f},{:d},{:.3f},{},{:.3f},{:.3f},{:d},{:d}", kind,
                   frame.index, m, error, bool{absent[m]}, e.covered, e.points, e.likeness,
                   verifier->usual_likeness(), e.known, verifier->experienced());
        for (const double f : verifier->features(e)) fmt::print(out_, ",{:.4g}", f);
        fmt::print(out_, "\n");
      }
    }
  }
  void learn(const Frame& frame, const Eigen::VectorXd& truth, const ColorMap& colors) {
    for (ModelVerifier& verifier : verifiers_)
      verifier.learn(verifier.measure_evidence(frame, truth, colors));
  }

 private:
  const Scene& scene_;
  std::FILE* out_;
  std::vector<ModelVerifier> verifiers_, fresh_;
};

/// A state that a recovery offered, and what the scene's search made of it.
struct Recovered {
  Eigen::VectorXd candidate, searched;
};

/// Recovers the models of a scene, by the scene's own search, from states that are far off.
class Recoveries {
 public:
  Recoveries(const std::string& file, const std::vector<std::string>& overrides,
             PluginLoader& plugins)
      : session_(open_scene(file, overrides, plugins)),
        scene_(*session_.scene),
        budget_(session_.parts.budget),
        limits_(session_.parts.status.motion),
        verifier_(scene_, session_.source->cameras()),
        recovery_(scene_, session_.source->cameras(), session_.parts.status.recovery) {
    session_.parts.cameras = session_.source->cameras();
    search_.emplace(scene_, session_.parts);
    if (budget_.evaluations == 0) budget_.evaluations = search_->default_evaluations();
  }

  /// States found in a frame for one model. `kept` has where it was `seconds` ago, and where the
  /// others are.
  std::vector<Recovered> find(const Frame& frame, const Eigen::VectorXd& kept, double seconds,
                              std::size_t model, const std::vector<bool>& shown,
                              std::uint64_t seed) {
    if (!verifier_.experienced(model)) return {};
    std::vector<Recovered> out;
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
        out.push_back({state, search_->settled(state, budget_, seed).state});
      }
    }
    return out;
  }

  void learn(const Frame& frame, const Eigen::VectorXd& truth) {
    const std::vector<bool> all(scene_.items().size(), true);
    search_->show(all);
    if (first_) search_->from_guess(frame, truth, budget_, 1);
    first_ = false;
    search_->look(frame, truth, false);
    search_->learn(frame, truth);
    verifier_.verify(frame, truth, search_->second_view_colors(), all);
    verifier_.learn(all);
    recovery_.remember(truth, all);
    recovery_.learn_backgrounds(frame, truth);
  }

 private:
  OpenedScene session_;
  const Scene& scene_;
  Budget budget_;
  MotionLimits limits_;
  PoseVerifier verifier_;
  Recovery recovery_;
  std::optional<FrameSearch> search_;
  bool first_ = true;
};

// A recovery takes as long as ten frames of tracking or more.
constexpr unsigned kRecoverEvery = 4;

int collect(const std::string& file, const std::string& csv, int frames, int seed,
            const std::vector<std::string>& overrides) {
  PluginLoader plugins(std::vector<std::filesystem::path>{});
  OpenedScene session = open_scene(file, overrides, plugins);
  const Scene& scene = *session.scene;
  const std::vector<Camera> cameras = session.source->cameras();
  std::FILE* out = std::fopen(csv.c_str(), "w");
  if (out == nullptr) throw std::runtime_error(csv + " cannot be written");
  Collector collector(scene, cameras, out);
  Recoveries recoveries(file, overrides, plugins);
  std::mt19937_64 random(static_cast<std::uint64_t>(seed));
  TileMaker tiles(scene, cameras, session.parts.tile);
  PhotometricMatch photometric(scene, session.parts.photometric);
  std::optional<SceneTracker> tracker;
  std::vector<Eigen::VectorXd> past;  // true states
  for (int k = 0; k < frames; ++k) {
    const std::optional<Frame> frame = session.source->next();
    if (!frame) break;
    if (!frame->truth) continue;
    const Eigen::VectorXd truth = frame->truth->state;
    const std::vector<bool> all(scene.items().size(), true);
    std::vector<bool> absent = frame->truth->absent;
    absent.resize(all.size(), false);
    const bool complete = std::ranges::find(absent, true) == absent.end();
    if (complete) past.push_back(truth);
    if (past.empty()) continue;
    if (!tracker)
      tracker.emplace(scene, std::move(session.parts), initial_state(session, *frame),
                      session.seed);
    const Eigen::Matrix3Xd landmarks =
        frame->truth->landmarks.size() > 0 ? frame->truth->landmarks : scene.landmarks(truth);
    tiles.leave_out(std::vector<bool>(scene.items().size(), false));
    TilePlan plan = tiles.plan(*frame, past.back());
    if (!photometric.knows()) photometric.begin(tiles, *frame, plan, past.back());
    photometric.apply(plan);
    const ColorMap colors = plan.views.size() > 1 ? plan.views[1].colors : ColorMap{};
    const Solution s = tracker->track(*frame);
    const auto add = [&](const char* kind, const Eigen::VectorXd& state,
                         const std::vector<bool>& shown) {
      std::vector<bool> hidden = shown;
      hidden.flip();
      tiles.leave_out(hidden);
      if (tiles.visible_share(state) > 0)
        collector.add(kind, *frame, state, landmarks, absent, colors, shown);
    };
    add("tracker", s.state, all);
    if (complete) add("truth", truth, all);
    static constexpr double kLadder[] = {2, 4, 7, 10, 15, 20, 25, 30, 40, 60, 100, 200};
    for (int i = 0; i < 5; ++i) {
      const double mm = kLadder[random() % std::size(kLadder)];
      const double kind = std::uniform_real_distribution<>(0, 1)(random);
      const Displacement by{mm * 1e-3 * (kind < 0.7),
                            mm * 0.6 * kDegree * (kind > 0.3 && kind < 0.9),
                            mm * 0.8 * kDegree * (kind > 0.5)};
      add("displaced", displaced(scene, past.back(), by, random()), all);
    }
    // One model, from where it was at some other time; the others are where they are, or lost, too.
    const std::size_t model = random() % all.size();
    const Scene::Item& item = scene.items()[model];
    Eigen::VectorXd kept = past.back();
    kept.segment(item.offset, item.model->dimension()) =
        past[random() % past.size()].segment(item.offset, item.model->dimension());
    std::vector<bool> shown(all.size(), random() % 3 != 0);
    shown[model] = true;
    std::vector<bool> only(all.size(), false);
    only[model] = true;
    const double seconds = std::uniform_real_distribution<>(0.05, 2)(random);
    const auto add_shown = [&](const char* kind, Eigen::VectorXd state) {
      for (std::size_t m = 0; m < shown.size(); ++m)
        if (!shown[m]) state.segment<3>(scene.items()[m].offset) += Eigen::Vector3d(0, 0, -20);
      add(kind, state, only);
    };
    if (random() % kRecoverEvery == 0)
      for (const Recovered& one : recoveries.find(*frame, kept, seconds, model, shown, random())) {
        add_shown("candidate", one.candidate);
        add_shown("recovered", one.searched);
      }
    if (!complete) continue;
    const Eigen::VectorXd& right = all_right(scene, s.state, landmarks) ? s.state : truth;
    collector.learn(*frame, right, colors);
    recoveries.learn(*frame, right);
    tiles.leave_out(std::vector<bool>(scene.items().size(), false));
    photometric.learn(tiles, *frame, tiles.plan(*frame, right), right);
  }
  std::fclose(out);
  return 0;
}

}  // namespace
}  // namespace hypotrack

int main(int argc, char** argv) try {
  if (argc < 5) {
    fmt::print(stderr, "collect_evidence SCENE.yaml OUT.csv FRAMES SEED [KEY=VALUE...]\n");
    return 2;
  }
  return hypotrack::collect(argv[1], argv[2], std::stoi(argv[3]), std::stoi(argv[4]),
                            {argv + 5, argv + argc});
} catch (const std::exception& e) {
  fmt::print(stderr, "collect_evidence: {}\n", e.what());
  return 1;
}
