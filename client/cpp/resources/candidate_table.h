#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tribodyn/client/connection.h"

namespace tribodyn::client {

/// A parameter in which candidates differ from their base.
struct CandidateParameter {
  const google::protobuf::FieldDescriptor* field;
  std::vector<double> values;  ///< one for each candidate, in the unit of the field
  /// Index of the column that holds it in CandidateTable::headers; absent: the server computed it.
  std::optional<std::size_t> column = {};
  std::string bare_unit = {};  ///< of cells without a unit

  /// Returns the name of the field, after "surface." if a lubricant has one of that name too.
  std::string header() const;
  /// Returns e.g. "lubricant.relaxation_time_seconds".
  std::string path() const;
};

/// Candidates of a screening: variants of one lubricant and surface, one a row.
struct CandidateTable {
  std::vector<std::string> names;               ///< by candidate
  std::vector<std::string> headers;             ///< of all columns but the names, as typed
  std::vector<std::vector<std::string>> cells;  ///< by candidate and header
  std::vector<std::string> refusals;            ///< by candidate; empty: it can be evaluated
  std::vector<bool> is_carried;                 ///< by header: the column is no parameter
  std::vector<CandidateParameter> parameters;
  /// Standard uncertainties of parameters, from columns FIELD.standard_uncertainty; 0: not stated.
  std::vector<CandidateParameter> uncertainties;
  /// By candidate, where columns hold measurements from which the server computes parameters; else
  /// empty.
  std::vector<v1::Lubricant> lubricants;
  std::map<std::string, std::string> headers_by_field;  ///< as typed
  std::string note;                                     ///< how cells were read; may be empty

  std::size_t size() const { return names.size(); }
};

/// The bases of candidates. An empty cell leaves the value of its base.
struct CandidateBase {
  v1::Lubricant lubricant;
  v1::Surface surface;
  /// The lubricant as rows of an import start from it (--like): without what the server computes.
  v1::Lubricant stated;
};

/// What lists the columns of a table that are carried along.
enum class CarriedBy {
  kFlag,      ///< --carry
  kCampaign,  ///< the campaign to which the table adds
};

/// Returns the candidates of a table. A column is a parameter of the lubricant or of the surface in
/// any spelling of RowColumn, with "lubricant." or "surface." before it where wanted; or a
/// measurement of the lubricant; or FIELD.standard_uncertainty; or the candidates' "name",
/// "candidate" or "id", without which they have the numbers of their rows; or it is carried along.
/// A header that resembles a parameter's name is an error unless `carried` lists it. Throws Failure
/// (kExitUsage) that lists every error.
CandidateTable read_candidates(const std::string& text, const std::string& path,
                               const CandidateBase& base, const std::vector<std::string>& carried,
                               CarriedBy carried_by = CarriedBy::kFlag);

/// Computes the parameters of candidates with measurements on the server, which stores nothing, and
/// sets `parameters` to those in which a candidate differs from the base. Sets the refusals of
/// those that the server rejects. Throws Failure (kExitUsage) if the server estimates parameters
/// whose uncertainty the table does not state.
void characterise_candidates(Connection& connection, const CandidateBase& base,
                             CandidateTable& table);

/// Returns the parameters of lubricants and surfaces.
std::vector<const google::protobuf::FieldDescriptor*> candidate_parameters();

/// Returns the parameter of lubricants or surfaces for a word as of find_parameter(), also after
/// "lubricant." or "surface."; without them first that of lubricants. Returns null and sets `wrong`
/// to a complaint with the nearest name of both if there is none.
const google::protobuf::FieldDescriptor* find_candidate_parameter(const std::string& word,
                                                                  std::string& wrong);

/// Returns the value of a parameter of the base, in the unit of the field; NaN if it has none.
double base_value(const CandidateBase& base, const google::protobuf::FieldDescriptor& field);

/// Returns the standard uncertainty that the base states of a parameter, in the unit of the field;
/// 0 if it states none. 0 too of the laws of viscosity and density: their parameters err together.
double stated_uncertainty(const CandidateBase& base,
                          const google::protobuf::FieldDescriptor& field);

/// Sets the refusals of candidates with a parameter outside the server's range, with the likely
/// slip.
void check_candidate_ranges(const v1::Schema& schema, CandidateTable& table);

}  // namespace tribodyn::client
