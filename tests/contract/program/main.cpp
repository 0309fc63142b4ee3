// hypotrack_contract_test KIND FILE.so [PARAMETERS.yaml]: tests a plugin against the contract of
// its kind, one row per promise. Exits 0 if no row failed, 1 if one did, 2 on a wrong command line.
#include <exception>
#include <iostream>
#include <map>

#include "base/standard_streams.hpp"
#include "plugin/crash_report.hpp"
#include "plugin/running_plugin.hpp"
#include "subject.hpp"
#include "test_models.hpp"

namespace {

using namespace hypotrack;
using namespace hypotrack::contract;

#define HYPOTRACK_KIND(name, Interface) {#name, check_##name},
const std::map<std::string, void (*)(Report&, const Subject&)> kChecks = {
    HYPOTRACK_PLUGIN_KINDS(HYPOTRACK_KIND)};
#undef HYPOTRACK_KIND

int run(Subject& subject) {
  subject.scene =
      std::make_unique<Scene>(std::vector<std::pair<std::string, std::shared_ptr<const Model>>>{
          {"hand", std::make_shared<Model>(test::make_test_hand())}});
  Report report;
  if (check_library(report, subject)) kChecks.at(subject.kind)(report, subject);
  return report.finish();
}

}  // namespace

int main(int argc, char** argv) {
  open_standard_streams();
  if (argc < 3 || argc > 4 || !kChecks.contains(argv[1])) {
    std::cerr << "usage: hypotrack_contract_test KIND FILE.so [PARAMETERS.yaml]\nKIND is one of";
    for (const auto& [kind, check] : kChecks) std::cerr << ' ' << kind;
    std::cerr << "; PARAMETERS.yaml holds what stands in the plugin's place in a scene.\nThe scene "
                 "around it is one hand of 27 parameters, named `hand`.\n";
    return 2;
  }
  Subject subject;
  subject.kind = argv[1];
  subject.library = argv[2];
  if (argc == 4) subject.config_file = argv[3];
  subject.who = subject.kind + " " + subject.library.string();
  const detail::RunningPlugin running(subject.who.c_str(), " in the row above");
  const detail::CrashReport crash_report;
  try {
    return run(subject);
  } catch (const std::exception& error) {
    std::cerr << "hypotrack_contract_test: " << error.what() << "\n";
    return 1;
  }
}
