#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "server/application/application.h"
#include "server/application/call_context.h"
#include "server/application/table_columns.h"
#include "server/contract/violations.h"
#include "server/simulation/candidate_figures.h"
#include "server/storage/stored_campaign.h"
#include "tribodyn/v1/campaigns.pb.h"

namespace tribodyn::server {

/// A campaign that has figures of the candidates.
struct FigureSource {
  FigureSource(Application& application, StoredCampaign campaign, const CallContext& call)
      : stored(std::move(campaign)), columns(application, stored, call) {}
  const StoredCampaign stored;
  TableColumns columns;
  std::vector<double> weights;  ///< of its conditions
};

/// A figure of candidates, found in a campaign.
struct FoundFigure {
  TableColumn column;
  v1::CandidateFigure::Aggregate aggregate = v1::CandidateFigure::MEAN;
  FigureSource* source = nullptr;
};

/// Reads figures of the candidates of a campaign, and of others with the same candidates.
class DecisionTable {
 public:
  /// Attribute with the names of candidates.
  static constexpr char kNames[] = "name";

  DecisionTable(Application& application, const StoredCampaign& stored, const CallContext& call)
      : application_(application), call_(call), own_(application, stored, call) {}

  /// Takes the weights of a request. Adds a violation if their number is wrong.
  void set_weights(const google::protobuf::RepeatedField<double>& stated, Violations& violations);

  /// Adds a figure to those that read_all() reads; a violation if there is no such campaign or
  /// column.
  void add(const v1::CandidateFigure& figure, const std::string& path, Violations& violations);
  void add(const v1::CandidateObjective& objective, const std::string& path,
           Violations& violations);
  void add(const google::protobuf::RepeatedPtrField<v1::CandidateConstraint>& constraints,
           Violations& violations);

  /// Reads all figures, and selects the candidates that the constraints, the last figures, keep.
  CandidateSelection read_all(
      const google::protobuf::RepeatedPtrField<v1::CandidateConstraint>& constraints);

  /// The figures of read_all(), in the order in which they were added.
  const std::vector<CandidateValues>& figures() const { return figures_; }
  const FoundFigure& found(std::size_t figure) const { return found_[figure]; }
  static ConditionAggregate aggregate(const FoundFigure& figure) {
    return {figure.aggregate, figure.source->weights};
  }
  TableColumns& columns() { return own_.columns; }
  bool is_of_rig() const { return own_.columns.request().has_rig(); }

  /// Returns the warnings of each candidate: bits of the column kWarningBits, of all of its rows.
  std::vector<std::uint32_t> warning_bits();
  /// Adds the warnings of candidates, one for each code.
  void add_warnings(const std::vector<std::size_t>& candidates,
                    google::protobuf::RepeatedPtrField<v1::CandidateWarning>& out);
  /// Returns which candidates have a row whose verdict a warning withholds.
  static bool is_withheld(std::uint32_t warning_bits);
  /// Returns candidates that have a refused row, with the reason of the first, at most `most`.
  std::vector<v1::RefusedCandidate> refused_candidates(int most);

  /// Returns the texts of an attribute; null if it has none or does not exist.
  const google::protobuf::RepeatedPtrField<std::string>* texts(const std::string& attribute);
  std::string label(std::size_t candidate);

 private:
  FigureSource* find_source(const std::string& name, const std::string& path,
                            Violations& violations);
  /// Calls visit(candidate, condition, bits) for each row of the campaign that has bits.
  template <class Visit>
  void visit_warnings(const Visit& visit);
  std::vector<double> rows(const StoredCampaign& stored, int column, std::int64_t candidate,
                           std::int64_t count);
  void add_missing(const StoredCampaign& stored, std::vector<bool>& missing);
  CandidateValues read(const FoundFigure& figure);
  std::vector<double> solver_errors(const StoredCampaign& stored, int column,
                                    const std::vector<double>& values, std::int64_t first,
                                    std::int64_t count);

  Application& application_;
  const CallContext& call_;
  FigureSource own_;
  std::deque<FigureSource> others_;
  std::vector<FoundFigure> found_;
  std::vector<CandidateValues> figures_;
};

/// Returns candidates by a figure, the best first, equal ones in their order.
std::vector<std::size_t> ordered(std::vector<std::size_t> candidates,
                                 const std::vector<double>& values, bool wants_most);

/// Sets how many candidates a decision does not take.
template <class Response>
void set_numbers(const CandidateSelection& selection, Response& out) {
  out.set_excluded(selection.excluded);
  out.set_refused(selection.refused);
  out.set_missing(selection.missing);
}

}  // namespace tribodyn::server
