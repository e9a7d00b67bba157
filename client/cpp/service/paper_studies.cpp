#include "client/cpp/service/paper_studies.h"

#include <set>
#include <string>

#include "client/cpp/failure.h"
#include "client/cpp/service/follow.h"
#include "client/cpp/service/interrupt.h"
#include "client/cpp/text/inputs.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {

PaperResults compute_paper_studies(const std::vector<const PaperFigure*>& figures,
                                   Connection& connection, ProgressForm form) {
  PaperResults results;
  std::vector<PaperCurve> curves;
  std::vector<v1::Simulation> submitted;
  std::vector<std::string> labels;
  std::set<std::string> known;
  InterruptText interrupts(kNothingSubmitted);
  for (const PaperFigure* figure : figures) {
    for (const PaperCurve& curve : figure->curves) {
      v1::Simulation simulation = simulation_of(curve);
      if (!known.insert(simulation.SerializeAsString()).second) continue;
      simulation.set_display_name("paper, figure " + figure->name);
      curves.push_back(curve);
      interrupts.set(interrupted_submission(connection, submitted, false));
      submitted.push_back(connection.create_simulation(simulation));
      labels.push_back(resource_id(simulation.lubricant()) + ", " +
                       model_options_text(simulation.model_options()));
    }
    for (const PaperRig& rig : figure->rigs) {
      const v1::EvaluateRigRequest request = request_of(rig);
      if (!known.insert(request.SerializeAsString()).second) continue;
      results.add(rig, connection.evaluate_rig(request));
    }
  }
  const std::vector<v1::Simulation> ended =
      submitted.empty() ? submitted : follow(connection, submitted, labels, form);
  for (std::size_t i = 0; i < ended.size(); ++i) {
    if (ended[i].state() != v1::Simulation::SUCCEEDED) {
      throw Failure(kExitFailed, ended[i].name() + " (" + labels[i] + ") " +
                                     state_text(ended[i].state()) + ": " +
                                     ended[i].error().message());
    }
    results.add(curves[i], ended[i]);
  }
  if (!ended.empty()) {
    results.add(connection.get<v1::GearSet>(ended.front().gear_set_revision()));
  }
  return results;
}

}  // namespace tribodyn::client
