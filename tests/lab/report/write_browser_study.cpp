// Writes the study that the browser test looks at: hand and box, with plots of every kind, a loss
// and a failure whose messages try to break out of the page.
#include <cstdio>
#include <exception>

#include "study_fixture.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s FOLDER\n", argv[0]);
    return 2;
  }
  hypotrack::test::StudyFixture study;
  study.title = "Budget </script><img src=x onerror=alert(1)> & \"quotes\"";
  study.seeds = 6;
  study.run.frames = 40;
  study.run.error_mm = 12;
  study.run.lost_from = 30;
  study.run.models =
      "[{name: hand, type: hand}, {name: box, type: rigid_box, size_mm: [90, 60, 40]}]";
  study.failure_message = "the plugin ended: </script><script>document.title='broken'</script>";
  study.plots =
      "  - {kind: curve, x: optimizer.particles, y: mean_error_mm, color: optimizer.generations, "
      "facet: scene}\n"
      "  - {kind: success, color: optimizer.particles, facet: scene}\n"
      "  - {kind: heatmap, x: optimizer.particles, y: optimizer.generations, "
      "value: mean_error_mm, facet: scene}\n"
      "  - {kind: bars, x: scene, y: mean_error_mm, color: optimizer.particles}\n"
      "  - {kind: convergence, color: optimizer.particles, facet: scene}\n"
      "  - {kind: targets, color: optimizer.particles}\n"
      "  - {kind: performance_profile, color: optimizer.particles}\n"
      "  - {kind: data_profile, color: optimizer.particles}\n"
      "  - {kind: expected_running_time, color: optimizer.particles, facet: scene}\n";
  study.trace = true;
  study.particles = {16, 32, 64};
  try {
    hypotrack::test::write_study(argv[1], study);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
  return 0;
}
