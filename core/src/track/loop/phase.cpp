#include "track/loop/phase.hpp"

#include <cstddef>
#include <stdexcept>

namespace hypotrack::internal {

Phase next(Phase phase, PhaseEvent event) {
  using enum Phase;
  using Row = std::array<Phase, kPhaseEventNames.size()>;
  // clang-format off
  static constexpr std::array<Row, kPhaseNames.size()> kNext{
      //  found      plausible  denied   departed  learned   forgotten  restarted
      Row{begun,     begun,     awaited, awaited,  lost,     sought,    awaited},  // awaited
      Row{begun,     begun,     awaited, awaited,  followed, tentative, awaited},  // begun
      Row{tentative, tentative, sought,  sought,   lost,     sought,    sought},  // sought
      Row{tentative, tentative, sought,  sought,   followed, tentative, sought},  // tentative
      Row{followed,  doubted,   lost,    absent,   followed, tentative, lost},  // followed
      Row{followed,  doubted,   lost,    absent,   doubted,  tentative, lost},  // doubted
      Row{followed,  doubted,   lost,    absent,   lost,     sought,    lost},  // lost
      Row{followed,  doubted,   lost,    absent,   absent,   sought,    lost},  // absent
  };
  // clang-format on
  return kNext[static_cast<std::size_t>(phase)][static_cast<std::size_t>(event)];
}

PhaseEvent event_of(Status judgement) {
  switch (judgement) {
    case Status::tracked:
      return PhaseEvent::found;
    case Status::uncertain:
      return PhaseEvent::plausible;
    case Status::lost:
      return PhaseEvent::denied;
    case Status::absent:
      return PhaseEvent::departed;
    case Status::missing:
      break;
  }
  throw std::invalid_argument("a frame that is missing is not judged");
}

}  // namespace hypotrack::internal
