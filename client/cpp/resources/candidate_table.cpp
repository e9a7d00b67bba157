#include "client/cpp/resources/candidate_table.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "client/cpp/failure.h"
#include "client/cpp/resources/edits.h"
#include "client/cpp/resources/row_table.h"
#include "client/cpp/text/inputs.h"
#include "client/cpp/text/nearest.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"
#include "proto/field_behavior.h"

namespace tribodyn::client {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using Kind = RowColumn::Kind;

/// Lubricants of one call: their answer stays far below the largest message.
constexpr std::size_t kCharacterisedAtOnce = 500;

const Descriptor* resource_of(const RowColumn& column) {
  return column.block != nullptr ? column.block->containing_type()
                                 : column.field->containing_type();
}

/// Whether a field is a parameter of a pressure-viscosity law.
bool is_of_law(const FieldDescriptor& field) {
  return field.containing_type() == v1::ImprovedYasutomi::descriptor();
}

/// Whether a column is a number that the model uses, if the server accepts its field.
bool is_parameter(const RowColumn& column) {
  return column.kind == Kind::kNumber && (column.block == nullptr || is_of_law(*column.field)) &&
         column.field->cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE &&
         !is_documentary(*column.field);
}

bool is_uncertainty(const RowColumn& column) {
  return column.kind == Kind::kProvenance && column.field != nullptr &&
         column.part == RowColumn::Part::kStandardUncertainty;
}

/// Whether the server computes parameters of a lubricant from the column.
bool is_measurement(const RowColumn& column) {
  if (column.field == nullptr || resource_of(column) != v1::Lubricant::descriptor()) return false;
  return column.kind == Kind::kMeasurements || column.kind == Kind::kColdViscosity ||
         (column.kind == Kind::kNumber && column.block != nullptr && !is_of_law(*column.field)) ||
         (column.kind == Kind::kClass && column.field->name() == "base_oil_class");
}

std::optional<RowColumn> name_column() {
  std::string ignored;
  return find_column(kind_of(*v1::Lubricant::descriptor()), "name", ignored);
}

/// Finds columns of candidates.
class ColumnFinder {
 public:
  ColumnFinder(const std::vector<std::string>& carried, CarriedBy carried_by)
      : carried_by_(carried_by) {
    for (const std::string& each : carried) unseen_.insert(each);
  }

  std::optional<RowColumn> find(const std::string& header, std::string& wrong) {
    if (carried_.count(header) != 0 || unseen_.erase(header) != 0) {
      carried_.insert(header);
      return std::nullopt;
    }
    const std::string word = plain_word(header);
    for (const char* each : {"name", "candidate", "candidate_id", "id"}) {
      if (word == each) return name_column();
    }
    const bool is_of_lubricant = word.starts_with("lubricant."),
               is_of_surface = word.starts_with("surface.");
    const std::string rest =
        is_of_lubricant || is_of_surface ? header.substr(header.find('.') + 1) : header;
    std::string meant;
    bool is_known = false;  // as another field
    for (const Descriptor* type : {v1::Lubricant::descriptor(), v1::Surface::descriptor()}) {
      if (type == v1::Lubricant::descriptor() ? is_of_surface : is_of_lubricant) continue;
      const ResourceKind& kind = kind_of(*type);
      std::string complaint;
      if (auto column = find_column(kind, rest, complaint)) {
        if (is_parameter(*column) || is_measurement(*column) || is_uncertainty(*column)) {
          return column;
        }
        if (column->kind == Kind::kNumber) {
          wrong = "is no parameter of candidates, but a field of a " + kind.singular + "; create " +
                  kind.plural + " with it (tribodyn " + kind.word + " import FILE)";
          if (type == v1::Lubricant::descriptor()) wrong += " and screen them with --lubricants";
          if (carried_by_ == CarriedBy::kFlag) {
            wrong += "; --carry '" + printable(header) + "' carries it along without effect";
          }
          return std::nullopt;
        }
        is_known = is_known || column->kind != Kind::kProvenance || column->field != nullptr;
        continue;
      }
      if (complaint.starts_with(kNotAColumn)) {
        wrong = complaint + ", and screen the lubricants with --lubricants";
        return std::nullopt;
      }
      if (is_known) continue;
      const std::string near = nearest_column(kind, rest);
      if (!near.empty() && complaint.starts_with("has the unit")) {
        wrong = complaint;
        return std::nullopt;
      }
      if (meant.empty()) meant = near;
    }
    if (is_known) return std::nullopt;
    if (!meant.empty()) {
      wrong = "is no parameter (is " + meant + " meant?)";
      wrong += carried_by_ == CarriedBy::kFlag
                   ? "; --carry '" + printable(header) + "' carries it along as it is"
                   : " and no column of the campaign";
    } else if (is_of_lubricant || is_of_surface) {
      wrong = "is no parameter; `tribodyn schema` lists them";
    }
    return std::nullopt;
  }

  /// Returns the headers to be carried that were not found.
  std::vector<std::string> unseen() const { return {unseen_.begin(), unseen_.end()}; }

 private:
  const CarriedBy carried_by_;
  std::set<std::string> unseen_;
  std::set<std::string> carried_;
};

double number_of(const Message& resource, const FieldDescriptor& field) {
  if (field.has_presence() && !resource.GetReflection()->HasField(resource, &field)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return resource.GetReflection()->GetDouble(resource, &field);
}

/// Returns the field of the lubricant, of its pressure-viscosity law or of the surface; NaN if it
/// is not set.
/// An oil without boundary friction has that of the surface, in a field of the same name; NaN if it
/// has a table by temperature in place of the field.
double number_in(const v1::Lubricant& lubricant, const v1::Surface& surface,
                 const FieldDescriptor& field) {
  if (field.containing_type() == v1::Surface::descriptor()) return number_of(surface, field);
  if (is_of_law(field)) return number_of(lubricant.improved_yasutomi(), field);
  const double stated = number_of(lubricant, field);
  const bool has_table = field.number() == v1::Lubricant::kAsperityFrictionCoefficientFieldNumber &&
                         !lubricant.asperity_friction_by_temperature().empty();
  const FieldDescriptor* of_surface = v1::Surface::descriptor()->FindFieldByName(field.name());
  const bool is_of_surface = std::isnan(stated) && !has_table && of_surface != nullptr;
  return is_of_surface ? number_of(surface, *of_surface) : stated;
}

/// Returns the path of a field of a lubricant within it.
std::string path_in_lubricant(const FieldDescriptor& field) {
  return (is_of_law(field) ? "improved_yasutomi." : "") + field.name();
}

/// Returns "0.5" for "0,5": in a table whose cells commas do not separate, that is a number.
std::string with_decimal_point(std::string text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) return text;
  std::string number = text;
  number[comma] = '.';
  double value = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  return error == std::errc() && end == number.data() + number.size() ? number : text;
}

/// Reads candidates row by row.
class CandidateReader {
 public:
  CandidateReader(const std::string& text, const std::string& path, const CandidateBase& base,
                  const std::vector<std::string>& carried, CarriedBy carried_by)
      : path_(path),
        base_(base),
        has_decimal_commas_(csv_separator(text) != ','),
        finder_(carried, carried_by),
        cells_(
            text, path,
            [this](const std::string& header, std::string& wrong) {
              return finder_.find(header, wrong);
            },
            wrong_) {}

  CandidateTable result() {
    for (const std::string& each : finder_.unseen()) {
      wrong_.add("--carry '" + printable(each) + "': the table has no such column");
    }
    out_.note = cells_.note();
    out_.headers_by_field = cells_.columns_by_name();
    read_columns();
    for (const CsvLine& line : cells_.lines()) read_row(line);
    for (const auto& [k, column] : wrong_columns_) {
      wrong_.add(column.first + (column.cells == 1 ? ""
                                                   : " (" + std::to_string(column.cells - 1) +
                                                         " more cells of the column are wrong)"));
    }
    if (wrong_.empty() && out_.names.empty()) wrong_.add("has no rows");
    if (!wrong_.empty()) {
      throw Failure(kExitUsage, path_ + ":\n  " + joined(wrong_.lines(), "\n  ") +
                                    "\n  Nothing was evaluated.");
    }
    return std::move(out_);
  }

 private:
  void read_columns() {
    for (std::size_t k = 0; k < cells_.header().size(); ++k) {
      if (cells_.is_name(k)) continue;
      const auto& column = cells_.columns()[k];
      out_.headers.push_back(printable(cells_.header()[k]));
      out_.is_carried.push_back(!column);
      if (!column) continue;
      has_measurements_ = has_measurements_ || is_measurement(*column);
      has_parameters_ = has_parameters_ || !is_uncertainty(*column);
    }
    if (!has_parameters_ && wrong_.empty()) {
      wrong_.add(
          "no column is a parameter or a measurement; `tribodyn help screening` says which "
          "columns there are");
    }
    std::size_t index = 0;
    for (std::size_t k = 0; k < cells_.header().size(); ++k) {
      const auto& column = cells_.columns()[k];
      if (cells_.is_name(k)) continue;
      const std::size_t at = index++;
      if (column && is_uncertainty(*column)) {
        out_.uncertainties.push_back({column->field, {}, at, unit_of_field(column->field->name())});
      }
      if (!column || !is_parameter(*column)) continue;
      const bool is_computed =
          has_measurements_ && resource_of(*column) == v1::Lubricant::descriptor();
      if (!is_computed) out_.parameters.push_back({column->field, {}, at, column->bare_unit});
    }
  }

  std::string name_in(const CsvLine& line) const {
    for (std::size_t k = 0; k < cells_.header().size(); ++k) {
      if (cells_.is_name(k)) return printable(line.cells[k]);
    }
    return std::to_string(out_.names.size() + 1);
  }

  /// Notes a cell that cannot be read: of each column the first in full.
  void add_wrong_cell(const CsvLine& line, std::size_t k, const std::string& wrong) {
    WrongColumn& column = wrong_columns_[k];
    if (column.cells++ == 0) {
      column.first = RowCells::row_text(line) + " " + cells_.column_text(k) + ": " + wrong;
    }
  }

  void read_uncertainty(const CsvLine& line, std::size_t k) {
    const FieldDescriptor* field = cells_.columns()[k]->field;
    const std::string unit = unit_of_field(field->name());
    double value = 0;
    if (!line.cells[k].empty()) {
      std::string wrong;
      // The uncertainty of a temperature is a difference.
      const auto read = read_quantity(line.cells[k], unit, unit, false, wrong);
      value = read.value_or(-1);
      if (read && value < 0) wrong = "is below 0";
      if (!wrong.empty()) {
        add_wrong_cell(line, k, "'" + printable(line.cells[k].substr(0, 60)) + "' " + wrong);
      }
    }
    for (CandidateParameter& each : out_.uncertainties) {
      if (each.field == field) each.values.push_back(value);
    }
  }

  void read_row(const CsvLine& line) {
    const std::string name = name_in(line);
    if (name.empty()) {
      wrong_.add(RowCells::row_text(line), "", "has no name");
    } else if (!names_.insert(name).second) {
      wrong_.add(RowCells::row_text(line), "", "has the name of an earlier row: " + name);
    }
    out_.names.push_back(name);
    out_.refusals.emplace_back();
    v1::Lubricant lubricant = has_measurements_ ? base_.stated : base_.lubricant;
    v1::Surface surface = base_.surface;
    std::vector<std::string>& typed = out_.cells.emplace_back();
    for (std::size_t k = 0; k < line.cells.size(); ++k) {
      const auto& column = cells_.columns()[k];
      if (cells_.is_name(k)) continue;
      typed.push_back(printable(line.cells[k]));
      if (!column && has_decimal_commas_) typed.back() = with_decimal_point(typed.back());
      if (column && is_uncertainty(*column)) read_uncertainty(line, k);
      if (!column || line.cells[k].empty() || is_uncertainty(*column)) continue;
      Message& resource = resource_of(*column) == v1::Surface::descriptor()
                              ? static_cast<Message&>(surface)
                              : lubricant;
      const std::string wrong = set_cell(*column, line.cells[k], resource);
      if (!wrong.empty()) add_wrong_cell(line, k, wrong);
    }
    for (CandidateParameter& parameter : out_.parameters) {
      parameter.values.push_back(number_in(lubricant, surface, *parameter.field));
      if (std::isnan(parameter.values.back())) {
        wrong_.add("column " + out_.headers[*parameter.column] + " has an empty cell in " +
                   RowCells::row_text(line) + ", and the base has no value");
      }
    }
    if (!has_measurements_) return;
    leave_law_to_viscosities(cells_, line, lubricant);
    out_.lubricants.push_back(std::move(lubricant));
  }

  struct WrongColumn {
    std::string first;
    std::size_t cells = 0;
  };

  const std::string path_;
  const CandidateBase& base_;
  const bool has_decimal_commas_;  ///< a comma in a number is a decimal comma
  std::map<std::size_t, WrongColumn> wrong_columns_;
  ColumnFinder finder_;
  GroupedComplaints wrong_;
  const RowCells cells_;
  bool has_measurements_ = false, has_parameters_ = false;
  std::set<std::string> names_;
  CandidateTable out_;
};

/// Returns the columns of the table that a path such as "lubricant.measurements.kv..." means, as
/// typed; empty if there is none.
std::string header_in(const CandidateTable& table, const std::string& path) {
  std::vector<std::string> parts = split(path, '.');
  std::reverse(parts.begin(), parts.end());
  for (const std::string& part : parts) {
    const auto found = table.headers_by_field.find(part.substr(0, part.find('[')));
    if (found != table.headers_by_field.end()) return found->second;
  }
  return "";
}

/// Notes the candidates that the server rejects; `sent` are the candidates of the batch. Returns
/// false if the rejection is not about candidates.
bool note_rejected(const ServiceError& error, const std::vector<std::size_t>& sent,
                   CandidateTable& table) {
  if (error.kind() != ServiceError::Kind::kRefused || error.violations().empty()) return false;
  constexpr std::string_view kStart = "requests[";
  for (const FieldViolation& each : error.violations()) {
    std::size_t index = 0;
    if (!each.field.starts_with(kStart)) return false;
    const char* last = each.field.data() + each.field.size();
    const auto read = std::from_chars(each.field.data() + kStart.size(), last, index);
    if (read.ec != std::errc() || index >= sent.size()) return false;
    std::string& refusal = table.refusals[sent[index]];
    if (!refusal.empty()) continue;  // the first reason is enough
    const std::string header = header_in(table, each.field);
    refusal = (header.empty() ? "" : "column " + header + ": ") + each.description;
  }
  return true;
}

/// Returns the lubricants of the candidates as the server completes them; those of rejected
/// candidates stay empty.
std::vector<v1::Lubricant> characterised(Connection& connection,
                                         const std::vector<const FieldDescriptor*>& fields,
                                         CandidateTable& table) {
  std::vector<v1::Lubricant> out(table.size());
  BatchOptions options;
  options.validate_only = true;
  for (const FieldDescriptor* field : fields) {
    options.read_mask.push_back(path_in_lubricant(*field));
  }
  options.read_mask.emplace_back("provenance");
  // Names that no lubricant has: nothing is written under them.
  const std::string prefix = "lubricants/candidate-of-a-screening-";
  for (std::size_t first = 0; first < table.size(); first += kCharacterisedAtOnce) {
    const std::size_t end = std::min(first + kCharacterisedAtOnce, table.size());
    for (bool is_done = false; !is_done;) {
      std::vector<std::size_t> sent;
      std::vector<v1::Lubricant> batch;
      for (std::size_t i = first; i < end; ++i) {
        if (!table.refusals[i].empty()) continue;
        sent.push_back(i);
        batch.push_back(table.lubricants[i]);
        batch.back().set_name(prefix + std::to_string(i + 1));
      }
      if (batch.empty()) break;
      try {
        std::vector<v1::Lubricant> answer = connection.create_all(batch, options);
        for (std::size_t i = 0; i < sent.size(); ++i) out[sent[i]] = std::move(answer[i]);
        is_done = true;
      } catch (const ServiceError& error) {
        if (!note_rejected(error, sent, table)) throw;
      }
    }
  }
  return out;
}

/// Throws Failure if the server estimated parameters whose uncertainty the table does not state: a
/// table has no column for the correlation of their errors, without which they would count as
/// exact.
void check_estimates(const std::vector<v1::Lubricant>& lubricants, const CandidateTable& table) {
  std::set<std::string> estimated;
  for (std::size_t i = 0; i < lubricants.size(); ++i) {
    for (const v1::ParameterProvenance& entry : lubricants[i].provenance()) {
      const bool is_uncertain_estimate = entry.computed() &&
                                         entry.provenance() == v1::PROVENANCE_ASSUMED &&
                                         entry.standard_uncertainty() > 0;
      const bool is_stated = std::any_of(
          table.uncertainties.begin(), table.uncertainties.end(), [&](const auto& each) {
            return each.field->name() == entry.field() && each.values[i] > 0;
          });
      if (is_uncertain_estimate && !is_stated) estimated.insert(label_of_field(entry.field()));
    }
  }
  if (estimated.empty()) return;
  throw Failure(kExitUsage,
                "a table cannot carry the uncertainty of what the server estimates: " +
                    joined(std::vector<std::string>(estimated.begin(), estimated.end()), ", ") +
                    ". Import it (tribodyn lubricants import FILE, then tribodyn screen "
                    "--lubricants ...), or "
                    "state these parameters in columns or in the base.\n  Nothing was evaluated.");
}

std::vector<const FieldDescriptor*> numbers_of_lubricants() {
  std::vector<const FieldDescriptor*> out;
  for (const RowColumn& column : columns_of(kind_of(*v1::Lubricant::descriptor()))) {
    if (is_parameter(column)) out.push_back(column.field);
  }
  return out;
}

}  // namespace

std::string CandidateParameter::header() const {
  const bool is_of_surface = field->containing_type() == v1::Surface::descriptor();
  const bool is_ambiguous =
      is_of_surface && v1::Lubricant::descriptor()->FindFieldByName(field->name()) != nullptr;
  return (is_ambiguous ? "surface." : "") + field->name();
}

std::string CandidateParameter::path() const {
  return field->containing_type() == v1::Surface::descriptor()
             ? "surface." + field->name()
             : "lubricant." + path_in_lubricant(*field);
}

std::vector<const FieldDescriptor*> candidate_parameters() {
  std::vector<const FieldDescriptor*> out = numbers_of_lubricants();
  for (const RowColumn& column : columns_of(kind_of(*v1::Surface::descriptor()))) {
    if (is_parameter(column)) out.push_back(column.field);
  }
  return out;
}

const FieldDescriptor* find_candidate_parameter(const std::string& word, std::string& wrong) {
  std::vector<std::string> words;
  for (const auto* type : {v1::Lubricant::descriptor(), v1::Surface::descriptor()}) {
    const ResourceKind& kind = kind_of(*type);
    const std::string owner = kind.singular + ".";
    const std::string own = word.starts_with(owner) ? word.substr(owner.size()) : word;
    if (const FieldDescriptor* field = find_parameter(kind, own, wrong)) return field;
    for (std::string& each : parameter_words(kind)) words.push_back(std::move(each));
  }
  const std::string meant = nearest(word, words);
  wrong = "'" + printable(word) + "' is not a parameter of a lubricant or a surface" +
          (meant.empty() ? "" : " (is " + meant + " meant?)");
  return nullptr;
}

double base_value(const CandidateBase& base, const FieldDescriptor& field) {
  return number_in(base.lubricant, base.surface, field);
}

double stated_uncertainty(const CandidateBase& base, const FieldDescriptor& field) {
  const bool is_of_law = field.name().starts_with("vogel_") || field.name().starts_with("density_");
  if (is_of_law) return 0;
  const bool is_of_surface = field.containing_type() == v1::Surface::descriptor();
  for (const v1::ParameterProvenance& entry :
       is_of_surface ? base.surface.provenance() : base.lubricant.provenance()) {
    if (entry.field() == (is_of_surface ? field.name() : path_in_lubricant(field))) {
      return entry.standard_uncertainty();
    }
  }
  return 0;
}

CandidateTable read_candidates(const std::string& text, const std::string& path,
                               const CandidateBase& base, const std::vector<std::string>& carried,
                               CarriedBy carried_by) {
  return CandidateReader(text, path, base, carried, carried_by).result();
}

void characterise_candidates(Connection& connection, const CandidateBase& base,
                             CandidateTable& table) {
  if (table.lubricants.empty()) return;
  const std::vector<const FieldDescriptor*> fields = numbers_of_lubricants();
  const std::vector<v1::Lubricant> lubricants = characterised(connection, fields, table);
  check_estimates(lubricants, table);
  for (const FieldDescriptor* field : fields) {
    // The law of the base determines alpha*, so that a column of it has no effect.
    const bool is_determined =
        base.lubricant.has_improved_yasutomi() && field->name().starts_with("pressure_viscosity_");
    if (is_determined) continue;
    const double usual = base_value(base, *field);
    CandidateParameter parameter{field, {}};
    bool differs = false;
    for (std::size_t i = 0; i < table.size(); ++i) {
      double value =
          table.refusals[i].empty() ? number_in(lubricants[i], base.surface, *field) : usual;
      if (std::isnan(value)) value = usual;
      differs = differs || (!std::isnan(value) && value != usual);
      parameter.values.push_back(value);
    }
    if (differs) table.parameters.push_back(std::move(parameter));
  }
}

void check_candidate_ranges(const v1::Schema& schema, CandidateTable& table) {
  for (const CandidateParameter& parameter : table.parameters) {
    const auto row = std::find_if(
        schema.constraints().begin(), schema.constraints().end(), [&](const v1::Constraint& each) {
          return each.message() == parameter.field->containing_type()->name() &&
                 each.field() == parameter.field->name();
        });
    if (row == schema.constraints().end()) continue;
    const std::string& name = parameter.field->name();
    for (std::size_t i = 0; i < table.size(); ++i) {
      const double value = parameter.values[i];
      if (!table.refusals[i].empty() || (value >= row->minimum() && value <= row->maximum())) {
        continue;
      }
      const std::string unit = row->unit().empty() ? "" : " " + row->unit();
      std::string& refusal = table.refusals[i];
      refusal = (parameter.column ? table.headers[*parameter.column] : name) + " = " +
                significant(value) + unit + "; allowed: " + significant(row->minimum()) + " to " +
                significant(row->maximum()) + unit;
      if (!row->reason().empty()) refusal += "; " + row->reason();
      const std::string typed = parameter.column ? table.cells[i][*parameter.column] : "";
      const std::string slip = unit_slip(typed, unit_of_field(name), parameter.bare_unit,
                                         row->minimum(), row->maximum());
      if (!slip.empty()) refusal += "; " + slip;
    }
  }
}

}  // namespace tribodyn::client
