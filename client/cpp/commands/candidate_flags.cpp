#include "client/cpp/commands/candidate_flags.h"

#include <cstddef>
#include <optional>

#include "client/cpp/commands/resource_writes.h"
#include "client/cpp/resources/candidate_table.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"

namespace tribodyn::client {
namespace {

/// Reads "PARAMETER=VALUE", e.g. "pressure-viscosity=0.5/GPa" or "relaxation-time=10%".
void read_uncertainty(const std::string& text, std::vector<v1::ParameterUncertainty>& out,
                      Complaints& complaints) {
  const std::string start = "--uncertainty: '" + printable(text) + "' ";
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) {
    complaints.push_back(start + "is not PARAMETER=VALUE");
    return;
  }
  const std::string word = text.substr(0, equals);
  std::string value = text.substr(equals + 1), wrong;
  const google::protobuf::FieldDescriptor* field = find_candidate_parameter(word, wrong);
  if (field == nullptr) {
    complaints.push_back("--uncertainty: " + wrong);
    return;
  }
  const bool is_relative = value.ends_with("%");
  if (is_relative) value.pop_back();
  const std::string unit = is_relative ? "" : unit_of_field(field->name());
  const std::string trade = trade_unit_of_field(field->name());
  // The uncertainty of a temperature is a difference.
  const std::string bare = unit.empty() ? "" : trade == "C" ? "K" : trade;
  const auto read = read_quantity(value, unit, bare, false, wrong);
  if (!read || !(*read > 0)) {
    complaints.push_back(start + (read ? "must be above 0" : wrong));
    return;
  }
  v1::ParameterUncertainty& added = out.emplace_back();
  added.set_parameter(CandidateParameter{field, {}}.path());
  if (is_relative) {
    added.set_relative_uncertainty(*read / 100);
  } else {
    added.set_absolute_uncertainty(*read);
  }
}

}  // namespace

void add_uncertainty_flag(FlagList& list, std::vector<v1::ParameterUncertainty>& out) {
  Flag& flag = list.raw("--uncertainty", "PARAMETER=VALUE",
                        "Standard uncertainty of a parameter, e.g. "
                        "pressure-viscosity=0.5/GPa or relaxation-time=10%; "
                        "repeatable. Of a parameter in the table it is each candidate's "
                        "own, of another one common to "
                        "all, as are those that the base states.");
  flag.is_repeatable = true;
  flag.read = [&out](const std::vector<std::string>& texts, Complaints& complaints) {
    for (const std::string& text : texts) read_uncertainty(text, out, complaints);
  };
}

void read_candidate_figure(const std::string& flag, const std::string& text,
                           v1::CandidateFigure& out, Complaints& complaints) {
  const std::size_t colon = text.rfind(':');
  const std::string kind = colon == std::string::npos ? "mean" : text.substr(colon + 1);
  std::string column = text.substr(0, colon);
  const std::size_t slash = column.rfind('/');
  if (slash != std::string::npos && slash > 0) {
    out.set_campaign(resource_name("campaigns", column.substr(0, slash)));
    column = column.substr(slash + 1);
  }
  if (column.empty() || (kind != "mean" && kind != "min" && kind != "max")) {
    complaints.push_back(flag + ": '" + printable(text) +
                         "' is not COLUMN, COLUMN:min, COLUMN:max or COLUMN:mean, each also after "
                         "CAMPAIGN/");
    return;
  }
  out.set_column(column);
  out.set_aggregate(kind == "min"   ? v1::CandidateFigure::MINIMUM
                    : kind == "max" ? v1::CandidateFigure::MAXIMUM
                                    : v1::CandidateFigure::MEAN);
}

void read_candidate_constraint(const std::string& flag, const std::string& text,
                               std::vector<v1::CandidateConstraint>& out, Complaints& complaints) {
  const std::size_t at = text.find_first_of("<>");
  const bool is_whole = at != std::string::npos && text.substr(at + 1, 1) == "=";
  std::string wrong = "is not FIGURE>=VALUE or FIGURE<=VALUE";
  const auto limit =
      is_whole ? read_quantity(text.substr(at + 2), "", "", false, wrong) : std::nullopt;
  if (!limit) {
    complaints.push_back(flag + ": '" + printable(text) + "' " + wrong);
    return;
  }
  v1::CandidateConstraint& added = out.emplace_back();
  read_candidate_figure(flag, text.substr(0, at), *added.mutable_figure(), complaints);
  if (text[at] == '>') {
    added.set_minimum(*limit);
  } else {
    added.set_maximum(*limit);
  }
}

}  // namespace tribodyn::client
