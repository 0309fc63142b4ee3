// Tracks a scene through pairs of pictures and prints where its landmarks are.
//
//   track_frames SCENE.yaml CALIBRATION.yaml LEFT.png RIGHT.png [LEFT.png RIGHT.png ...]
#include <cstdio>
#include <exception>
#include <hypotrack/api/calibration.hpp>
#include <hypotrack/api/session.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>

int main(int argc, char** argv) try {
  if (argc < 5 || argc % 2 == 0) {
    std::fprintf(stderr, "usage: track_frames SCENE CALIBRATION LEFT RIGHT [LEFT RIGHT ...]\n");
    return 2;
  }
  hypotrack::Session session(argv[1]);
  hypotrack::Tracker tracker = session.tracker(hypotrack::load_calibration({.file = argv[2]}));
  const auto& names = tracker.scene().landmark_names();
  for (int i = 3; i < argc; i += 2) {
    hypotrack::Frame frame;
    frame.index = (i - 3) / 2;
    frame.time = frame.index / 30.0;  // seconds
    for (const char* file : {argv[i], argv[i + 1]})
      frame.views.push_back({.color = cv::imread(file, cv::IMREAD_COLOR)});
    const hypotrack::Solution solution = tracker.track(frame);
    std::printf("frame %d: %s\n", frame.index, std::string(to_string(solution.status)).c_str());
    for (std::size_t k = 0; k < names.size(); ++k) {
      const Eigen::Vector3d p = 1000 * solution.landmarks.col(static_cast<Eigen::Index>(k));
      std::printf("  %-24s %8.1f %8.1f %8.1f mm\n", names[k].c_str(), p.x(), p.y(), p.z());
    }
  }
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "track_frames: %s\n", e.what());
  return 1;
}
