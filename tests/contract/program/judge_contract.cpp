#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "hypotrack/api/error.hpp"
#include "subject.hpp"

namespace hypotrack::contract {
namespace {

using Values = std::array<double, Measures::kCount>;

// Of a textured box in rendered views: at its true pose, and 60 mm beside it.
constexpr Values kRight{0.98, 0.95, 0.98, 1.2, 0.7, 0.1, 1.6, 0.9, 0.95,
                        0.6,  0.9,  0.1,  1.0, 1.0, 0.9, 0.8, 0.3, 0.8};
constexpr Values kWrong{0.1,  0.05, 0.05, 1.2, 1.7, 0.05, 1.7, 0.3, 0.2,
                        -0.1, 0.2,  0.3,  1.0, 1.0, 0.0,  0.0, 0.9, 0.0};

Measures measures_of(const Values& values, bool experienced) {
  Measures out{.values = values, .experienced = experienced, .points = 2000, .known = true};
  if (!experienced) return out;
  out.usual = kRight;
  out.likeness = values == kRight ? 0.8 : 0.1;
  out.usual_likeness = 0.8;
  out.tracked = true;
  return out;
}

/// Makes measures as pictures may give them, and at the ends of their ranges.
std::vector<Measures> all_measures() {
  std::vector<Measures> out;
  for (const bool experienced : {false, true}) {
    for (const Values& values : {kRight, kWrong}) out.push_back(measures_of(values, experienced));
    for (const double same : {-1.0, 0.0, 0.5, 1.0, 2.5}) {
      Values values;
      values.fill(same);
      out.push_back(measures_of(values, experienced));
    }
  }
  out.push_back(measures_of(kRight, true));
  out.back().likeness = std::numeric_limits<double>::quiet_NaN();
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> share(-1, 2.5);
  for (int i = 0; i < 200; ++i) {
    Values values;
    for (double& value : values) value = share(random);
    out.push_back(measures_of(values, i % 2 == 0));
    out.back().tracked = i % 3 == 0;
    out.back().covered = (share(random) + 1) / 3.5;
  }
  return out;
}

/// Makes poses of a box: right ones near kRight, wrong ones near kWrong.
JudgeFit clear_poses() {
  JudgeFit out;
  std::mt19937_64 random(2);
  std::normal_distribution<double> noise(0, 0.1);
  for (const bool experienced : {false, true})
    for (int i = 0; i < 600; ++i) {
      const bool right = i % 2 == 0;
      Values values = right ? kRight : kWrong;
      for (double& value : values) value += noise(random);
      out.poses.push_back({.measures = measures_of(values, experienced),
                           .error = right ? 0.004 : 0.06,
                           .searched = i % 3 == 0,
                           .sequence = i % 8});
    }
  out.models = {"box"};
  out.source = "poses that are easy to tell apart";
  return out;
}

/// Throws unless a judge finds the pose of a box likelier than one beside it.
void check_order(const Judge& judge) {
  for (const bool experienced : {false, true}) {
    const double right = judge.log_odds(measures_of(kRight, experienced));
    const double wrong = judge.log_odds(measures_of(kWrong, experienced));
    require(right > wrong, "the log odds of a box at its pose are " + std::to_string(right) +
                               ", and 60 mm beside it " + std::to_string(wrong));
  }
}

void check_fit(Report& report, const Subject& subject) {
  const auto judge = subject.make<Judge>();
  const JudgeFit poses = clear_poses();
  FittedJudge fitted;
  report.row("fitted to clear poses it tells right from wrong", [&] {
    if (!subject.claims("fits")) throw Skipped("its capabilities do not claim that it fits");
    fitted = judge->fit(poses);
    require(fitted.judge != nullptr, "it gives no judge");
    require(!fitted.file.empty(), "the text of its file is empty");
    check_order(*fitted.judge);
  });
  if (!fitted.judge) return;
  report.row("equal poses give equal fits",
             [&] { require(judge->fit(poses).file == fitted.file, "it gives another one"); });
  report.row("it refuses to be fitted to nothing", [&] {
    try {
      judge->fit({});
    } catch (const DataError&) {
      return;
    }
    throw Violation("it was fitted, expected a DataError");
  });
}

std::vector<double> answers(const Judge& judge, const std::vector<Measures>& to) {
  std::vector<double> out;
  for (const Measures& one : to) out.push_back(judge.log_odds(one));
  return out;
}

void check_thresholds(const JudgeThresholds& t) {
  for (const auto& [name, value] :
       {std::pair("tracked_above", t.tracked_above), std::pair("certain_above", t.certain_above),
        std::pair("first_above", t.first_above), std::pair("confirmed_above", t.confirmed_above)}) {
    require(value >= 0 && value <= 1,
            std::string(name) + " is " + std::to_string(value) + ", expected 0 to 1");
    require(value >= t.uncertain_above,
            std::string(name) + " is " + std::to_string(value) + ", below uncertain_above, " +
                std::to_string(t.uncertain_above) + ": a lost model would be tracked");
  }
}

}  // namespace

void check_judge(Report& report, const Subject& subject) {
  if (!check_parameters<Judge>(report, subject)) return;
  const auto judge = subject.make<Judge>();
  const std::vector<Measures> all = all_measures();
  std::vector<double> first;
  report.row("it answers any measures with a number or an infinity",
             [&] { first = answers(*judge, all); });
  if (first.empty()) return;
  report.row("asked twice it answers the same",
             [&] { require(answers(*judge, all) == first, "it gives other answers"); });
  report.row("a second object answers the same", [&] {
    require(answers(*subject.make<Judge>(), all) == first, "it gives other answers");
  });
  report.row("several threads get the same answers", [&] {
    std::array<std::vector<double>, 4> found;
    {
      std::vector<std::jthread> threads;
      for (auto& one : found) threads.emplace_back([&] { one = answers(*judge, all); });
    }
    for (const auto& one : found) require(one == first, "four threads differ from one");
  });
  report.row("its thresholds are probabilities, and lost models are not tracked",
             [&] { check_thresholds(judge->thresholds()); });
  report.row("a right pose is likelier than one beside it", [&] { check_order(*judge); });
  check_fit(report, subject);
}

}  // namespace hypotrack::contract
