#include "output/run/truth_output.hpp"

#include <fmt/format.h>

#include <string>

#include "hypotrack/api/tables.hpp"
#include "output/evaluate/true_landmarks.hpp"
#include "output/table_text.hpp"

namespace hypotrack::internal {

void TruthOutput::open() {
  landmarks_.emplace(run_->file("truth_landmarks.csv"));
  landmarks_->write(landmarks_header(run_->scene().landmark_names()));
  errors_.emplace(run_->file("errors.csv"));
  std::string header = "frame,time,status,mean_joint_error_mm";
  for (const std::string& model : layout_->models) header += "," + model;
  errors_->write(header + "\n");
}

void TruthOutput::add(const Frame& frame, const Eigen::Matrix3Xd& landmarks,
                      const FrameError& error, std::string_view status) {
  if (!errors_) open();
  landmarks_->write(landmarks_line(frame.index, frame.time, landmarks,
                                   absent_landmarks(run_->scene(), frame.truth->absent)));
  std::string line =
      fmt::format("{},{},{},{:.4f}", frame.index, frame.time, status, 1000 * error.mean);
  for (const double model : error.models) line += fmt::format(",{:.4f}", 1000 * model);
  errors_->write(line + "\n");
  if (frame.truth->state.size() == 0) return;
  if (!states_) {
    states_.emplace(run_->file("truth_states.csv"));
    states_->write(states_header(run_->scene()));
  }
  states_->write(table_line(frame.index, frame.time, frame.truth->state));
}

}  // namespace hypotrack::internal
