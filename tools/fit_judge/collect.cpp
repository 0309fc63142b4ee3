// Writes evidence of right and wrong poses of a rendered scene, for fit.py: what the scene's
// tracker finds, the true pose, and poses off by 1 to 200 mm.
//
//   collect_evidence SCENE.yaml OUT.csv FRAMES SEED [KEY=VALUE...]
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "hypotrack/kinematics.hpp"
#include "hypotrack/plugin.hpp"
#include "judge/judge.hpp"
#include "session/displace.hpp"
#include "session/session.hpp"
#include "track/photometric.hpp"
#include "track/tracker.hpp"

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

struct Row {
  const char* kind;
  int frame;
};

class Collector {
 public:
  Collector(const Scene& scene, const std::vector<Camera>& cameras, std::FILE* out)
      : scene_(scene), out_(out) {
    for (std::size_t m = 0; m < scene.items().size(); ++m) {
      judges_.emplace_back(scene, m, cameras);
      fresh_.emplace_back(scene, m, cameras);
    }
    fmt::print(out_, "kind,frame,model,error,absent,covered,points,known,experienced");
    for (const char* prefix : {"", "d_"})
      for (const auto name : evidence_names()) fmt::print(out_, ",{}{}", prefix, name);
    fmt::print(out_, "\n");
  }

  void add(const char* kind, const Frame& frame, const Eigen::VectorXd& state,
           const Eigen::Matrix3Xd& truth, bool absent, const ColorMap& colors) {
    Eigen::Index first = 0;
    for (std::size_t m = 0; m < judges_.size(); ++m) {
      const Scene::Item& item = scene_.items()[m];
      const double error = absent ? 999 : error_mm(item, state, truth, first);
      first += static_cast<Eigen::Index>(item.model->data().landmarks.size());
      for (ModelJudge* judge : {&judges_[m], &fresh_[m]}) {
        const Evidence e = judge->look(frame, state, colors);
        fmt::print(out_, "{},{},{},{:.2f},{:d},{:.3f},{},{:d},{:d}", kind, frame.index, m, error,
                   absent, e.covered, e.points, e.known, judge->experienced());
        for (const double f : judge->features(e)) fmt::print(out_, ",{:.4g}", f);
        fmt::print(out_, "\n");
      }
    }
  }
  void learn(const Frame& frame, const Eigen::VectorXd& truth, const ColorMap& colors) {
    for (ModelJudge& judge : judges_) judge.learn(judge.look(frame, truth, colors));
  }

 private:
  const Scene& scene_;
  std::FILE* out_;
  std::vector<ModelJudge> judges_, fresh_;
};

int collect(const std::string& file, const std::string& csv, int frames, int seed,
            const std::vector<std::string>& overrides) {
  PluginLoader plugins(std::vector<std::filesystem::path>{});
  Session session = open_session(file, overrides, plugins);
  const Scene& scene = *session.scene;
  const std::vector<Camera> cameras = session.source->cameras();
  std::FILE* out = std::fopen(csv.c_str(), "w");
  Collector collector(scene, cameras, out);
  std::mt19937_64 random(static_cast<std::uint64_t>(seed));
  TileMaker tiles(scene, cameras, session.parts.tile);
  PhotometricMatch photometric(scene, session.parts.photometric);
  std::optional<Tracker> tracker;
  Eigen::VectorXd last_good;
  for (int k = 0; k < frames; ++k) {
    const std::optional<Frame> frame = session.source->next();
    if (!frame) break;
    if (!frame->truth) continue;
    const Eigen::VectorXd truth = frame->truth->state;
    const bool absent = truth[2] < 0;
    if (!absent) last_good = truth;
    if (!tracker)
      tracker.emplace(scene, std::move(session.parts), initial_state(session, *frame),
                      session.seed);
    const Eigen::Matrix3Xd landmarks =
        frame->truth->landmarks.size() > 0 ? frame->truth->landmarks : scene.landmarks(truth);
    TilePlan plan = tiles.plan(*frame, last_good);
    if (!photometric.knows()) photometric.begin(tiles, *frame, plan, last_good);
    photometric.apply(plan);
    const ColorMap colors = plan.cuts.size() > 1 ? plan.cuts[1].colors : ColorMap{};
    const Solution s = tracker->track(*frame);
    if (tiles.visible_share(s.state) > 0)
      collector.add("tracker", *frame, s.state, landmarks, absent, colors);
    if (!absent) collector.add("truth", *frame, truth, landmarks, absent, colors);
    static constexpr double kLadder[] = {2, 4, 7, 10, 15, 20, 25, 30, 40, 60, 100, 200};
    for (int i = 0; i < 5; ++i) {
      const double mm = kLadder[random() % std::size(kLadder)];
      const double kind = std::uniform_real_distribution<>(0, 1)(random);
      const Displacement by{mm * 1e-3 * (kind < 0.7),
                            mm * 0.6 * kDegree * (kind > 0.3 && kind < 0.9),
                            mm * 0.8 * kDegree * (kind > 0.5)};
      const Eigen::VectorXd off = displaced(scene, last_good, by, random());
      if (tiles.visible_share(off) > 0)
        collector.add("displaced", *frame, off, landmarks, absent, colors);
    }
    if (absent) continue;
    collector.learn(*frame, truth, colors);
    photometric.learn(tiles, *frame, tiles.plan(*frame, truth), truth);
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
